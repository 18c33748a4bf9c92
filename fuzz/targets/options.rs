//! Any JSON is options or an error, and options that are written read back as themselves.
#![no_main]

use libfuzzer_sys::fuzz_target;
use seamstress::{CertifyOptions, IntegerMapOptions, MapOptions, QuadOptions, SurfaceOptions};
use serde_json::{from_slice, to_string, to_value};

macro_rules! check {
    ($data:expr, $($options:ty),*) => {$(
        if let Ok(options) = from_slice::<$options>($data) {
            let text = to_string(&options).unwrap();
            let again: $options = serde_json::from_str(&text).unwrap();
            assert_eq!(to_value(&again).unwrap(), to_value(&options).unwrap());
        }
    )*};
}

fuzz_target!(|data: &[u8]| {
    check!(data, CertifyOptions, IntegerMapOptions, MapOptions, QuadOptions, SurfaceOptions);
});
