//! Names of bodies and groups, as people write them: `NAME=BODY,BODY` and `A,B`.

use pliant_check::Group;

/// A comma or an equals sign inside a name would end it.
const OTHERWISE: &str = "a body whose name has a comma or an equals sign is named by its number";

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

pub(super) fn two(text: &str) -> Result<super::Names, String> {
    match text.split(',').collect::<Vec<_>>()[..] {
        [a, b] if !a.is_empty() && !b.is_empty() => Ok([a, b].map(str::to_owned)),
        _ => Err(format!(
            "write A,B, or A,A for bodies of one group; {OTHERWISE}"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::{group, two};

    #[test]
    fn names_are_read_as_they_are_written() {
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
