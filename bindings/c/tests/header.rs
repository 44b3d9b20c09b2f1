//! The header says what the crate has, and programs in C and C++ that include it do what they
//! should.

use std::collections::BTreeSet;
use std::env::{consts, current_exe};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn header() -> String {
    fs::read_to_string(root().join("include/pliant.h")).unwrap()
}

/// The header without comments, each run of white space as one blank.
fn code() -> String {
    let header = header();
    let mut code = String::new();
    let mut rest = &header[..];
    while let Some(start) = rest.find("/*") {
        code.push_str(&rest[..start]);
        let end = rest[start..].find("*/").unwrap();
        rest = &rest[start + end + 2..];
    }
    code.push_str(rest);
    code.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Names of functions with their count of parameters, behind each `mark`.
fn functions(text: &str, mark: &str) -> BTreeSet<(String, usize)> {
    let mut all = BTreeSet::new();
    for (at, _) in text.match_indices(mark) {
        let rest = &text[at + mark.len()..];
        let Some(open) = rest.find('(') else { continue };
        let name = rest[..open].trim();
        if !name.starts_with("pliant_") || !name.chars().all(|c| c.is_alphanumeric() || c == '_') {
            continue;
        }
        let list = &rest[open + 1..open + rest[open..].find(')').unwrap()];
        let parameters = list.split(',').map(str::trim);
        let count = parameters.filter(|it| !["", "void"].contains(it)).count();
        all.insert((name.to_owned(), count));
    }
    all
}

#[test]
fn the_header_has_the_functions_of_the_crate() {
    let mut exported = BTreeSet::new();
    for file in fs::read_dir(root().join("src")).unwrap() {
        let text = fs::read_to_string(file.unwrap().path()).unwrap();
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        exported.extend(functions(&text, "extern \"C\" fn "));
        // A macro makes some: their names are in the rows of its calls.
        for made in text.split("macro_rules! ").skip(1) {
            let (name, rest) = made.split_once(' ').unwrap();
            let Some((_, list)) = rest.split_once("extern \"C\" fn $name(") else {
                continue;
            };
            let list = list.split_once(") ->").unwrap().0;
            let fixed = list.replace("$($number: f64,)?", "");
            let fixed = fixed.replace("$($number: $type,)+", "");
            let fixed = fixed.split(',').filter(|it| !it.trim().is_empty()).count();
            let Some((_, rows)) = text.split_once(&format!("{name}! {{ ")) else {
                continue;
            };
            let rows = rows.split_once('}').unwrap().0.split(';');
            for row in rows.filter(|row| !row.trim().is_empty()) {
                // Numbers are in parentheses behind the name, or in columns behind the method.
                let (name, numbers) = match row.split_once('(') {
                    Some((name, rest)) if name.trim().starts_with("pliant_") => {
                        let numbers = rest.split_once(')').unwrap().0;
                        (name.trim(), numbers.split(',').count())
                    }
                    _ => {
                        let columns: Vec<&str> = row.split(',').map(str::trim).collect();
                        (columns[1], columns.len() - 3)
                    }
                };
                exported.insert((name.to_owned(), fixed + numbers));
            }
        }
    }
    let declared = functions(&code().replace('*', " "), " ");
    assert!(exported.len() > 5);
    assert_eq!(declared, exported);
}

/// Methods of Rust's worlds without a function of C, so far.
const LATER: [&str; 44] = [
    "apply",
    "bodies",
    "clearance",
    "components",
    "distance",
    "edit",
    "end_positions",
    "environment",
    "filter",
    "finish_motion",
    "first_impact",
    "free_step",
    "fuse",
    "ignored",
    "interruptible",
    "labels",
    "live_triangles",
    "live_vertices",
    "loose_box",
    "memory_usage",
    "mesh_revision",
    "nearest_body",
    "options",
    "rebuild",
    "rest_positions",
    "set_loose_box",
    "set_positions_of",
    "set_thickness",
    "split",
    "statistics",
    "thickness",
    "tree_boxes",
    "tree_cut",
    "tree_quality",
    "tree_shape",
    "triangles",
    "unignore",
    "validate",
    "vertex_groups",
    "vertex_order",
    "weld",
    "with_options",
    "with_pool",
    "write_positions",
];

/// Texts of all files below a folder.
fn texts(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let of = |path: PathBuf| {
        if path.is_dir() {
            texts(&path)
        } else {
            vec![fs::read_to_string(path).unwrap()]
        }
    };
    entries.flat_map(of).collect()
}

#[test]
fn methods_of_worlds_have_a_function_or_are_named_as_left() {
    let mut methods = BTreeSet::new();
    for text in texts(&root().join("../../crates/pliant/src/world")) {
        for block in text.split("\nimpl<S: Scalar> World<S> {\n").skip(1) {
            let block = block.split("\n}\n").next().unwrap();
            let mut is_hidden = false;
            for line in block.lines() {
                if let Some(rest) = line.strip_prefix("    pub fn ") {
                    let end = rest
                        .find(|c: char| !c.is_alphanumeric() && c != '_')
                        .unwrap();
                    if !is_hidden {
                        methods.insert(rest[..end].to_owned());
                    }
                }
                is_hidden = line.contains("doc(hidden)");
            }
        }
    }
    // One function gives both counts.
    let counts = ["triangle_count", "vertex_count"];
    let declared = functions(&code().replace('*', " "), " ");
    let has = |name: &str| {
        let name = format!("pliant_world_{name}");
        declared.iter().any(|(declared, _)| *declared == name)
    };
    let missing = methods.iter().map(String::as_str);
    let missing: Vec<_> = missing
        .filter(|name| !has(name) && !counts.contains(name))
        .collect();
    assert_eq!(missing, LATER);
}

#[test]
fn the_version_is_that_of_the_crate() {
    let header = header();
    let part = |name: &str| {
        let mark = format!("#define PLIANT_VERSION_{name} ");
        let rest = header.split(&mark).nth(1).unwrap();
        rest.lines().next().unwrap().to_owned()
    };
    let parts = ["MAJOR", "MINOR", "PATCH"].map(part).join(".");
    assert_eq!(parts, env!("CARGO_PKG_VERSION"));
}

#[test]
fn every_statement_of_the_header_is_for_a_reader_of_100_columns() {
    let classes = fs::read_to_string(root().join("include/pliant.hpp")).unwrap();
    for header in [header(), classes] {
        let long: Vec<_> = header.lines().filter(|line| line.len() > 100).collect();
        assert_eq!(long, [""; 0]);
    }
}

/// Runs a command, and returns what it printed; it must succeed.
fn succeeds(command: &mut Command) -> String {
    let ran = command.output().unwrap();
    let said = String::from_utf8_lossy(&ran.stderr);
    assert!(ran.status.success(), "{command:?}: {said}");
    String::from_utf8(ran.stdout).unwrap()
}

#[test]
#[ignore = "for releases: needs CMake and pkg-config"]
fn strangers_find_what_is_installed() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    // A folder of its own: the library of the tests beside this one has the same name.
    let mut install = Command::new(root().join("install"));
    install.arg(at.join("there")).env("PROFILE", "dev");
    succeeds(install.env("CARGO_TARGET_DIR", libraries().join("installed")));
    let project = "cmake_minimum_required(VERSION 3.18)
        project(stranger C CXX)
        find_package(pliant 0.1.0 REQUIRED)
        add_executable(world_c world.c)
        target_link_libraries(world_c pliant::pliant m)
        add_executable(world_cpp world.cpp)
        target_compile_features(world_cpp PRIVATE cxx_std_17)
        target_link_libraries(world_cpp pliant::pliant)";
    fs::write(at.join("CMakeLists.txt"), project).unwrap();
    for file in ["check.h", "world.c", "world.cpp"] {
        fs::copy(root().join("tests").join(file), at.join(file)).unwrap();
    }
    let there = format!("-DCMAKE_PREFIX_PATH={}", at.join("there").display());
    let build = at.join("build");
    succeeds(
        Command::new("cmake")
            .arg("-S")
            .arg(at)
            .arg("-B")
            .arg(&build)
            .arg(there),
    );
    succeeds(Command::new("cmake").arg("--build").arg(&build));
    succeeds(&mut Command::new(build.join("world_c")));
    succeeds(&mut Command::new(build.join("world_cpp")));

    let packages = at.join("there/lib/pkgconfig");
    let mut flags = Command::new("pkg-config");
    flags
        .args(["--cflags", "--libs", "pliant"])
        .env("PKG_CONFIG_PATH", packages);
    let flags = succeeds(&mut flags);
    let program = at.join("by_pkg_config");
    let mut compile = Command::new("cc");
    compile.arg(at.join("world.c")).arg("-o").arg(&program);
    succeeds(compile.args(flags.split_whitespace()).arg("-lm"));
    succeeds(Command::new(program).env("LD_LIBRARY_PATH", at.join("there/lib")));
}

/// The folder that has the libraries beside this program.
fn libraries() -> PathBuf {
    let program = current_exe().unwrap();
    let folders = program.ancestors().skip(1).take(2);
    let name = format!("{}pliant_c{}", consts::DLL_PREFIX, consts::DLL_SUFFIX);
    let mut with_library = folders.filter(|folder| folder.join(&name).is_file());
    with_library
        .next()
        .expect("cargo builds the library first")
        .to_owned()
}

/// Whether a compiler is there; says so if not.
fn is_there(compiler: &str) -> bool {
    let is = Command::new(compiler).arg("--version").output().is_ok();
    if !is {
        eprintln!("skipped: there is no {compiler}");
    }
    is
}

/// Compiles a file with the header and the library, and runs it, by another program if there is
/// one. Returns what it printed.
fn run(compiler: &str, flags: &[&str], file: &Path, by: &[&str]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let (program, libraries) = (folder.path().join("program"), libraries());
    let warnings = ["-Wall", "-Wextra", "-Wpedantic", "-Werror"];
    let compiled = Command::new(compiler)
        .args(flags)
        .args(warnings)
        .arg("-I")
        .arg(root().join("include"))
        .arg(file)
        .arg("-o")
        .arg(&program)
        .arg("-L")
        .arg(&libraries)
        .arg(format!("-Wl,-rpath,{}", libraries.display()))
        .args(["-x", "none", "-lpliant_c", "-lm"])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&compiled.stderr);
    assert!(compiled.status.success(), "{compiler} {flags:?}: {said}");
    let mut command = by.to_vec();
    command.push(program.to_str().unwrap());
    let ran = Command::new(command[0])
        .args(&command[1..])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&ran.stderr);
    assert!(ran.status.success(), "{compiler} {flags:?}: {said}");
    String::from_utf8(ran.stdout).unwrap()
}

const PROGRAMS: [&str; 2] = ["tests/pairs.c", "tests/world.c"];

#[test]
fn programs_in_c_and_in_cpp_do_what_they_should() {
    for file in PROGRAMS.map(|file| root().join(file)) {
        for compiler in ["cc", "clang"] {
            if is_there(compiler) {
                run(compiler, &["-std=c11", "-g"], &file, &[]);
            }
        }
        for compiler in ["c++", "clang++"] {
            if is_there(compiler) {
                run(compiler, &["-std=c++17", "-g", "-x", "c++"], &file, &[]);
            }
        }
    }
}

/// Flags for the classes, with Eigen where it is installed.
const CLASSES: [&str; 4] = ["-std=c++17", "-g", "-isystem", "/usr/include/eigen3"];

#[test]
fn classes_do_what_they_should() {
    for compiler in ["c++", "clang++"] {
        if is_there(compiler) {
            run(compiler, &CLASSES, &root().join("tests/world.cpp"), &[]);
        }
    }
}

#[test]
#[ignore = "for releases: needs the sanitizers and valgrind"]
fn programs_run_clean_under_sanitizers_and_valgrind() {
    for file in PROGRAMS.map(|file| root().join(file)) {
        let sanitized = [
            "-std=c11",
            "-g",
            "-fsanitize=address,undefined",
            "-fno-sanitize-recover",
        ];
        run("cc", &sanitized, &file, &[]);
        let valgrind = [
            "valgrind",
            "--quiet",
            "--error-exitcode=9",
            "--leak-check=full",
        ];
        run("cc", &["-std=c11", "-g"], &file, &valgrind);
    }
    let flags = [&CLASSES[..], &["-fsanitize=address,undefined"]].concat();
    run("c++", &flags, &root().join("tests/world.cpp"), &[]);
}

#[test]
fn classes_have_a_method_for_each_function() {
    let classes = fs::read_to_string(root().join("include/pliant.hpp")).unwrap();
    let functions = functions(&code().replace('*', " "), " ");
    let is_called = |(name, _): &(String, usize)| {
        classes.contains(&format!("{name},"))
            || classes.contains(&format!("{name}("))
            || classes.contains(&format!("{name})"))
    };
    let worlds = functions
        .into_iter()
        .filter(|it| it.0.starts_with("pliant_world_"));
    let left: Vec<_> = worlds.filter(|it| !is_called(it)).map(|it| it.0).collect();
    assert_eq!(left, [""; 0]);
}

#[test]
fn the_program_of_the_readme_says_what_falls() {
    if !is_there("cc") {
        return;
    }
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    let program = readme.split("```c\n").nth(1).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("falls.c");
    fs::write(&file, program.split("```").next().unwrap()).unwrap();
    let said = run("cc", &["-std=c11"], &file, &[]);
    let expected = "free up to 0.65; vertex 0 of body 1 meets triangle 0 of body 0 by 0.666667\n";
    assert_eq!(said, expected);
}
