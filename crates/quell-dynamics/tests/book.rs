//! The book's page on Rust shows the example and its output as they are.

use std::fs;
use std::path::Path;

#[path = "../examples/quench.rs"]
mod quench;

#[test]
fn the_page_shows_the_example_and_its_output() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let example = fs::read_to_string(root.join("examples/quench.rs")).expect("the example");
    let path = root.join("../../docs/book/src/howto/rust.md");
    let page = fs::read_to_string(&path).expect("the page");
    let part = |text: &str, after: &str| -> (usize, usize) {
        let begins = text.find(after).expect("the block") + after.len();
        (begins, begins + text[begins..].find("```").expect("its end"))
    };
    let mut expected = page.clone();
    for (fence, content) in [("```rust\n", example), ("```text\n", quench::answer().expect("ok"))] {
        let (begins, ends) = part(&expected, fence);
        expected.replace_range(begins..ends, &content);
    }
    if std::env::var_os("QUELL_BLESS").is_some() {
        fs::write(&path, &expected).expect("written");
    }
    assert!(
        expected == page || std::env::var_os("QUELL_BLESS").is_some(),
        "QUELL_BLESS=1 writes it"
    );
}
