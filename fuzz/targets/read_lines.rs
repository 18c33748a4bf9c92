//! Any bytes are feature edges, cones, a field or a matching, or an error.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let _ = seamstress_io::parse_pairs(data, "fuzzed");
    let _ = seamstress_io::parse_sharp(data, "fuzzed");
    for n in [0, 1, 4] {
        let _ = seamstress_io::parse_cones(data, "fuzzed", n);
        let _ = seamstress_io::parse_rawfield(data, "fuzzed", n);
        let _ = seamstress_io::parse_rosy(data, "fuzzed", n);
        let _ = seamstress_io::parse_matching(data, "fuzzed", n);
    }
});
