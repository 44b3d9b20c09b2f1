//! Reads bodies, prints their contents and the time it took: `frames [--no-weld] BODY...`.

use std::time::Instant;

use pliant_io::{Error, OpenOptions, looks_like_a_series};

fn main() -> Result<(), Error> {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let options = OpenOptions {
        weld: !arguments.iter().any(|argument| argument == "--no-weld"),
        ..OpenOptions::default()
    };
    arguments.retain(|argument| argument != "--no-weld");
    if let Some(pattern) = looks_like_a_series(&arguments) {
        eprintln!("to read these files as the frames of one body, quote the pattern: '{pattern}'");
    }
    for argument in &arguments {
        let begin = Instant::now();
        let mut body = pliant_io::open(argument, &options)?;
        let opened = begin.elapsed();
        while body.next_frame()?.is_some() {}
        println!(
            "{body:?}\nopened in {opened:.1?}, read in {:.1?}",
            begin.elapsed()
        );
    }
    Ok(())
}
