//! Choosing the reader for a file.

use std::borrow::Cow;
use std::fs;
use std::io::Read;
use std::path::Path;

use flate2::read::MultiGzDecoder;

use crate::error::{Fault, Missing, Parsed, ReadErrorKind};
use crate::text::quote;
use crate::{Format, Note, PolygonMesh, ReadError, gltf, obj, off, ply, stl};

/// Reads a mesh file.
///
/// The extension says the format, unless the content is plainly of another one: then the content
/// decides, with a [`Note::ExtensionContradicted`]. Content compressed with gzip is unpacked, whatever the name.
///
/// # Errors
/// [`ReadError`] if the file cannot be read or is not a mesh.
pub fn read_mesh(path: &Path) -> Result<PolygonMesh, ReadError> {
    read_mesh_as(path, None)
}

/// Reads a mesh file as one of a format, that of its name if none is given.
///
/// # Errors
/// As [`read_mesh`].
pub fn read_mesh_as(path: &Path, format: Option<Format>) -> Result<PolygonMesh, ReadError> {
    let name = path.display().to_string();
    let bytes = read_content(path)?;
    let format = format.or_else(|| Format::from_path(path));
    parse(&bytes, format, path.parent()).map_err(|fault| fault.named(&name))
}

/// Reads the content of a file, unpacked if gzip has compressed it.
///
/// # Errors
/// [`ReadError`] if the file cannot be read.
pub fn read_content(path: &Path) -> Result<Vec<u8>, ReadError> {
    let content = fs::read(path).map_err(|error| Fault::whole_file(ReadErrorKind::Io(error)));
    let unpacked = content.and_then(|bytes| {
        // Other content is not copied.
        let unpacked = match unpacked(&bytes)? {
            Cow::Owned(content) => Some(content),
            Cow::Borrowed(_) => None,
        };
        Ok(unpacked.unwrap_or(bytes))
    });
    unpacked.map_err(|fault| fault.named(&path.display().to_string()))
}

/// Reads a mesh from memory.
///
/// `format` is what the caller believes the content to be, such as from a file name; a plain
/// contradiction in the content overrules it, with a [`Note::ExtensionContradicted`]. `name` stands for
/// the data in error messages.
///
/// # Errors
/// [`ReadError`] if the content is not a mesh.
pub fn parse_mesh(
    bytes: &[u8],
    format: Option<Format>,
    name: &str,
) -> Result<PolygonMesh, ReadError> {
    parse(bytes, format, None).map_err(|fault| fault.named(name))
}

/// Parses content whose further files, those of glTF, are in a folder.
fn parse(bytes: &[u8], claimed: Option<Format>, folder: Option<&Path>) -> Parsed<PolygonMesh> {
    let bytes = &*unpacked(bytes)?;
    refuse_empty_or_packed(bytes)?;
    let format = match claimed {
        Some(claimed) => Format::detect_by_keyword(bytes).unwrap_or(claimed),
        None => Format::detect(bytes).ok_or_else(|| {
            let found = quote(&bytes[..bytes.len().min(16)]);
            Fault::whole_file(ReadErrorKind::UnknownFormat { found })
        })?,
    };
    let mut mesh = match format {
        Format::Obj => obj::parse(bytes),
        Format::Off => off::parse(bytes),
        Format::Ply => ply::parse(bytes),
        Format::Stl => stl::parse(bytes),
        Format::Gltf => gltf::parse(bytes, folder),
    }?;
    if let Some(claimed) = claimed
        && claimed != format
    {
        mesh.notes.insert(0, Note::ExtensionContradicted { claimed, found: format });
    }
    Ok(mesh)
}

/// The content of what gzip has compressed, and other content as it is.
fn unpacked(bytes: &[u8]) -> Parsed<Cow<'_, [u8]>> {
    if !bytes.starts_with(&[0x1f, 0x8b]) {
        return Ok(bytes.into());
    }
    let mut content = Vec::new();
    match MultiGzDecoder::new(bytes).read_to_end(&mut content) {
        Ok(_) => Ok(content.into()),
        Err(error) => Err(Fault::whole_file(ReadErrorKind::Io(error))),
    }
}

/// Refuses content that no reader can do anything with.
fn refuse_empty_or_packed(bytes: &[u8]) -> Parsed<()> {
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(Fault::whole_file(ReadErrorKind::Empty(Missing::Content)));
    }
    let what = match bytes {
        [b'P', b'K', 3, 4, ..] => "the file is a zip archive; unpack it first",
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => "the text is UTF-16; save it as UTF-8",
        _ => return Ok(()),
    };
    Err(Fault::unsupported(None, what))
}

#[cfg(test)]
mod tests {
    use super::*;

    const OBJ: &[u8] = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

    #[test]
    fn content_overrules_the_name() {
        let mesh = parse_mesh(OBJ, Some(Format::Off), "a.off").unwrap();
        assert_eq!(mesh.format, Format::Obj);
        assert_eq!(
            mesh.notes,
            [Note::ExtensionContradicted { claimed: Format::Off, found: Format::Obj }]
        );
        assert_eq!(parse_mesh(OBJ, Some(Format::Obj), "a.obj").unwrap().notes, []);
        let off = parse_mesh(b"OFF 1 1 0\n0 0 0\n3 0 0 0", Some(Format::Stl), "a").unwrap();
        assert_eq!(off.format, Format::Off);
    }

    #[test]
    fn compressed_content_is_unpacked() {
        let mut packed = Vec::new();
        let mut encoder = flate2::read::GzEncoder::new(OBJ, flate2::Compression::default());
        encoder.read_to_end(&mut packed).unwrap();
        let plain = parse_mesh(OBJ, Some(Format::Obj), "a.obj").unwrap();
        assert_eq!(parse_mesh(&packed, Some(Format::Obj), "a.obj.gz").unwrap(), plain);
        let file = std::env::temp_dir().join(format!("seamstress-{}.obj.gz", std::process::id()));
        fs::write(&file, &packed).unwrap();
        assert_eq!(read_content(&file).unwrap(), OBJ);
        fs::remove_file(&file).unwrap();
        let torn = parse_mesh(&packed[..packed.len() - 9], None, "a.obj.gz").unwrap_err();
        assert!(torn.to_string().starts_with("a.obj.gz: cannot be read: "), "{torn}");
    }

    #[test]
    fn unclear_content_follows_the_name() {
        let error = parse_mesh(b"1 2 3\n", Some(Format::Obj), "a.obj").unwrap_err();
        let expected = "a.obj, line 1: expected an OBJ statement such as `v` or `f` (the file has none), found `1`";
        assert_eq!(error.to_string(), expected);
    }

    #[test]
    fn nothing_to_read() {
        let fault = |bytes: &[u8]| parse_mesh(bytes, None, "a").unwrap_err().to_string();
        assert_eq!(fault(b""), "a: the file is empty");
        assert_eq!(fault(b" \r\n"), "a: the file is empty");
        assert!(fault(b"\x1f\x8b\x08").starts_with("a: cannot be read: "));
        assert_eq!(fault(b"\xff\xfev\0"), "a: the text is UTF-16; save it as UTF-8");
        let unknown = "a: the format is not known (OBJ, OFF, PLY, STL and glTF are read); the content starts with `<html>`";
        assert_eq!(fault(b"<html>"), unknown);
    }

    #[test]
    fn a_missing_file_is_named() {
        let error = read_mesh(Path::new("no/such/mesh.obj")).unwrap_err();
        assert!(error.to_string().starts_with("no/such/mesh.obj: cannot be read: "), "{error}");
        assert!(matches!(error.kind, ReadErrorKind::Io(_)));
    }
}
