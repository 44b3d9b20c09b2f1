//! Sizes in bytes on the command line: `4GiB`, `512MiB`, `1G`, `65536`.

/// Parses a size. Units are powers of 1024, in upper or lower case, with or without `iB`.
pub(crate) fn parse(text: &str) -> Result<u64, String> {
    let help = "write a number of bytes, or one with a unit: 65536, 512MiB, 4G";
    let end = text
        .find(|c: char| !c.is_ascii_digit())
        .unwrap_or(text.len());
    let (digits, unit) = text.split_at(end);
    let shift = match unit.to_ascii_lowercase().as_str() {
        "" | "b" => 0,
        "k" | "kib" => 10,
        "m" | "mib" => 20,
        "g" | "gib" => 30,
        "t" | "tib" => 40,
        // Ambiguous: powers of 1000 for some, of 1024 for others.
        "kb" | "mb" | "gb" | "tb" => {
            let binary = format!("{}iB", unit[..1].to_ascii_uppercase());
            return Err(format!(
                "{unit} is ambiguous; write {binary} for powers of 1024"
            ));
        }
        _ => return Err(help.to_owned()),
    };
    let number: u64 = digits.parse().map_err(|_| help.to_owned())?;
    number
        .checked_mul(1 << shift)
        .ok_or_else(|| "more bytes than any memory has; write fewer: 4G".to_owned())
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn sizes_are_read_as_people_write_them() {
        for (text, bytes) in [
            ("4GiB", 4 << 30),
            ("512MiB", 512 << 20),
            ("1G", 1 << 30),
            ("65536", 65536),
            ("0", 0),
            ("7b", 7),
            ("3k", 3 << 10),
            ("2tib", 2 << 40),
            ("18446744073709551615", u64::MAX),
        ] {
            assert_eq!(parse(text), Ok(bytes), "{text}");
        }
        for text in [
            "",
            "G",
            "-1",
            "+1",
            "1.5G",
            "1 G",
            "1GB",
            "1X",
            "1GiBs",
            "G1",
            "é",
            "1é",
            "18446744073709551616",
            "16777216T",
        ] {
            assert!(parse(text).is_err(), "{text}");
        }
        assert!(parse("1GB").unwrap_err().contains("GiB"));
    }
}
