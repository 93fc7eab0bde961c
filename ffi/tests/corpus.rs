//! Replays the fuzzer's corpus of call sequences: what once was interesting stays tested.

#[path = "../../fuzz/calls.rs"]
mod calls;

#[test]
fn sequences_of_calls() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus/calls");
    let mut count = 0;
    for file in std::fs::read_dir(&folder).unwrap() {
        calls::calls(&std::fs::read(file.unwrap().path()).unwrap());
        count += 1;
    }
    assert!(count > 0, "{} is empty", folder.display());
    println!("calls: {count} inputs");
}
