//! Names of bodies, groups and files on the command line: `NAME=BODY,BODY`, `A,B`, `BODY=FILE`.

use pliant_check::{Baseline, Group, LabelFile, Rest};
use pliant_io::shown;

/// Advice where a name contains a separator: a comma or an equals sign would end it.
const OTHERWISE: &str = "a body whose name has a comma or an equals sign is named by its number";

/// Two names, written `A,B`.
pub(super) type Names = [String; 2];

pub(super) fn group(text: &str) -> Result<Group, String> {
    let (name, bodies) = text
        .split_once('=')
        .filter(|(name, _)| !name.is_empty())
        .ok_or_else(|| format!("write NAME=BODY,BODY; {OTHERWISE}"))?;
    let bodies = bodies.split(',').filter(|body| !body.is_empty());
    Ok(Group {
        name: name.to_owned(),
        bodies: bodies.map(str::to_owned).collect(),
    })
}

pub(super) fn two(text: &str) -> Result<Names, String> {
    match text.split(',').collect::<Vec<_>>()[..] {
        [a, b] if !a.is_empty() && !b.is_empty() => Ok([a, b].map(str::to_owned)),
        _ => Err(format!(
            "write A,B, or A,A for bodies of one group; {OTHERWISE}"
        )),
    }
}

/// Parses a baseline: a number is a frame, anything else a file.
pub(super) fn baseline(text: &str) -> Result<Baseline, String> {
    Ok(frame(text)?.map_or_else(|| Baseline::File(text.into()), Baseline::Frame))
}

/// Parses a rest shape: a number is a frame, anything else a file.
pub(super) fn rest(text: &str) -> Result<Rest, String> {
    Ok(frame(text)?.map_or_else(|| Rest::File(text.into()), Rest::Frame))
}

/// Parses labels: `BODY=FILE.npy`. The file is behind the last equals sign.
pub(super) fn labels(text: &str) -> Result<LabelFile, String> {
    let (body, file) = text
        .rsplit_once('=')
        .filter(|(body, file)| !body.is_empty() && !file.is_empty())
        .ok_or("write BODY=FILE.npy, a body by its name or number, and a file of integers")?;
    Ok(LabelFile {
        body: body.to_owned(),
        file: file.into(),
    })
}

/// Pairs that labels leave out, in words.
pub(super) fn labelled(labels: &[LabelFile]) -> Option<String> {
    let bodies: Vec<_> = labels.iter().map(|it| shown(&it.body)).collect();
    let of = bodies.join(", ");
    (!bodies.is_empty()).then(|| format!("triangles of {of} whose labels are equal or neighbours"))
}

/// Pairs that a rest shape leaves out, in words.
pub(super) fn at_rest(rest: &Rest) -> String {
    let shape = match rest {
        Rest::Frame(frame) => format!("frame {frame}"),
        Rest::File(file) => shown(file),
    };
    format!("triangles of one file that are as close in {shape}")
}

/// Parses the number of a frame, which a file may take the place of.
fn frame(text: &str) -> Result<Option<usize>, String> {
    let is_number = text.parse::<f64>().is_ok();
    is_number.then(|| crate::report::frame(text)).transpose()
}

/// Whether a name has the form of a piece: `FILE#1`, counted from 1.
pub(super) fn is_of_a_piece(name: &str) -> bool {
    let number = name
        .rsplit_once('#')
        .map(|(_, number)| number.parse::<u32>());
    matches!(number, Some(Ok(1..)))
}

#[cfg(test)]
mod tests {
    use super::{baseline, group, is_of_a_piece, labels, rest, two};
    use pliant_check::{Baseline, Rest};

    #[test]
    fn pieces_have_numbers_from_one() {
        for name in ["a.ply#1", "scene.glb#arm#12", "#1"] {
            assert!(is_of_a_piece(name), "{name}");
        }
        for name in [
            "a.ply",
            "a.ply#",
            "a.ply#0",
            "scene.glb#arm",
            "1",
            "",
            "a#1,",
        ] {
            assert!(!is_of_a_piece(name), "{name}");
        }
    }

    #[test]
    fn baselines_are_frames_or_files() {
        assert_eq!(baseline("12"), Ok(Baseline::Frame(12)));
        for file in ["old.json", "./12", "12.json", "a 1"] {
            assert_eq!(baseline(file), Ok(Baseline::File(file.into())));
        }
        for bad in ["-1", "1.5"] {
            assert!(baseline(bad).is_err(), "{bad}");
        }
        assert_eq!(rest("0"), Ok(Rest::Frame(0)));
        assert_eq!(rest("flat.ply"), Ok(Rest::File("flat.ply".into())));
    }

    #[test]
    fn names_are_read_as_they_are_written() {
        let read = labels("a=b.ply=parts.npy").unwrap();
        assert_eq!(
            (&read.body[..], &*read.file),
            ("a=b.ply", "parts.npy".as_ref())
        );
        for text in ["parts.npy", "=parts.npy", "a.ply="] {
            assert!(labels(text).unwrap_err().contains("BODY=FILE.npy"));
        }
        let read = group("soft=shirt_*.obj,2,hair.ply#3").unwrap();
        assert_eq!(read.name, "soft");
        assert_eq!(read.bodies, ["shirt_*.obj", "2", "hair.ply#3"]);
        assert_eq!(group("soft=").unwrap().bodies, [""; 0]);
        for text in ["soft,hard", "=soft", ""] {
            assert!(group(text).unwrap_err().contains("number"), "{text}");
        }
        assert_eq!(two("a.ply,b.ply"), Ok(["a.ply", "b.ply"].map(String::from)));
        for text in ["", "a", "a,", ",a", ",", "a,b,c"] {
            assert!(two(text).unwrap_err().contains("A,B"), "{text}");
        }
    }
}
