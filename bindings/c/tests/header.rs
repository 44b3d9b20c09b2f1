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

/// Macros of the crate that make functions, and how many parameters they add to those in a row of
/// their calls.
const MADE_BY: [(&str, usize); 7] = [
    ("calls", 2),
    ("uses", 2),
    ("plain", 2),
    ("lists", 3),
    ("questions", 4),
    ("impacts", 5),
    ("contacts", 5),
];

/// The text up to the brace that closes it.
fn block(text: &str) -> &str {
    let mut depth = 0;
    let end = text.find(|c| {
        depth += i32::from(c == '{') - i32::from(c == '}');
        depth < 0
    });
    &text[..end.unwrap()]
}

/// The functions of the crate, with their counts of parameters.
fn exported() -> BTreeSet<(String, usize)> {
    let mut all = BTreeSet::new();
    for file in fs::read_dir(root().join("src")).unwrap() {
        let text = fs::read_to_string(file.unwrap().path()).unwrap();
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        all.extend(functions(&text, "extern \"C\" fn "));
        for (name, added) in MADE_BY {
            for call in text.split(&format!(" {name}! {{ ")).skip(1) {
                let call = block(call);
                // Rows are functions, or say name, method and perhaps a number.
                let rows: Vec<&str> = if call.contains("fn pliant_") {
                    call.split("fn ").skip(1).collect()
                } else {
                    call.split(';').collect()
                };
                for row in rows.into_iter().filter(|row| row.contains("pliant_")) {
                    let row = &row[row.find("pliant_").unwrap()..];
                    let end = row
                        .find(|c: char| !c.is_alphanumeric() && c != '_')
                        .unwrap();
                    let (function, rest) = row.split_at(end);
                    let list = match rest.split_once('(') {
                        Some((_, list)) => list.split(')').next().unwrap(),
                        None => rest.split(',').nth(2).unwrap_or(""),
                    };
                    let arguments = list.split(',').filter(|it| !it.trim().is_empty());
                    all.insert((function.to_owned(), added + arguments.count()));
                }
            }
        }
    }
    all
}

#[test]
fn the_header_has_the_functions_of_the_crate() {
    let declared = functions(&code().replace('*', " "), " ");
    assert!(declared.len() > 90);
    assert_eq!(declared, exported());
}

/// Methods of Rust's worlds whose function of C has another name.
const ELSEWHERE: [(&str, &str); 7] = [
    ("interruptible", "pliant_world_distance"),
    ("triangle_count", "pliant_world_counts"),
    ("vertex_count", "pliant_world_counts"),
    ("with_options", "pliant_world_new"),
    ("with_pool", "pliant_world_new"),
    ("with_scheduler", "pliant_world_new"),
    ("write_positions", "pliant_world_set_positions"),
];

/// Methods of Rust's edits whose function of C has another name.
const OF_EDITS: [(&str, &str); 6] = [
    ("add_triangle", "pliant_edit_add_triangles"),
    ("add_vertex", "pliant_edit_add_vertices"),
    ("body", "pliant_edit_counts"),
    ("remove_triangle", "pliant_edit_remove_triangles"),
    ("triangle_count", "pliant_edit_counts"),
    ("vertex_count", "pliant_edit_counts"),
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

/// Names of the public methods in a block of implementations that begins so.
fn methods(text: &str, begins: &str) -> BTreeSet<String> {
    let mut all = BTreeSet::new();
    for block in text.split(begins).skip(1) {
        let block = block.split("\n}\n").next().unwrap();
        let mut is_hidden = false;
        for line in block.lines() {
            if let Some(rest) = line.strip_prefix("    pub fn ")
                && !is_hidden
            {
                let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_');
                all.insert(rest[..end.unwrap()].to_owned());
            }
            is_hidden = line.contains("doc(hidden)");
        }
    }
    all
}

#[test]
fn every_method_of_worlds_edits_and_changes_has_a_function() {
    let source = root().join("../../crates/pliant/src");
    let declared: BTreeSet<String> = functions(&code().replace('*', " "), " ")
        .into_iter()
        .map(|(name, _)| name)
        .collect();
    let check = |methods: BTreeSet<String>, prefix: &str, elsewhere: &[(&str, &str)]| {
        assert!(methods.len() > 5);
        for method in methods {
            let other = elsewhere.iter().find(|(name, _)| *name == method);
            let own = format!("{prefix}{method}");
            let name = other.map_or(&own[..], |(_, function)| function);
            assert!(declared.contains(name), "{name}");
        }
    };
    let worlds = texts(&source.join("world")).join("\n");
    let worlds = methods(&worlds, "\nimpl<S: Scalar> World<S> {\n");
    check(worlds, "pliant_world_", &ELSEWHERE);
    let text = |file| fs::read_to_string(source.join(file)).unwrap();
    let edits = methods(&text("edit.rs"), "\nimpl<S: Copy> Edit<S> {\n");
    check(edits, "pliant_edit_", &OF_EDITS);
    let changes = methods(&text("changes.rs"), "\nimpl<H: Listed> Changes<H> {\n");
    check(
        changes,
        "pliant_changes_",
        &[("follow", "pliant_changes_edges_edited")],
    );
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
fn every_line_is_for_a_reader_of_100_columns() {
    for folder in ["include", "tests", "examples"] {
        for text in texts(&root().join(folder)) {
            let is_long = |line: &&str| line.chars().count() > 100;
            let long: Vec<_> = text.lines().filter(is_long).collect();
            assert_eq!(long, [""; 0]);
        }
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
    let warnings = ["-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Werror"];
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
    // Cargo's own may have an older library first.
    let ran = Command::new(command[0])
        .args(&command[1..])
        .env("LD_LIBRARY_PATH", &libraries)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&ran.stderr);
    assert!(ran.status.success(), "{compiler} {flags:?}: {said}");
    String::from_utf8(ran.stdout).unwrap()
}

const PROGRAMS: [&str; 5] = [
    "tests/pairs.c",
    "tests/world.c",
    "tests/answers.c",
    "tests/inside.c",
    "tests/edits.c",
];

/// Compiles and runs the programs in C, by compilers of C and of C++.
fn programs(c: &str, cpp: &str) {
    for file in PROGRAMS.map(|file| root().join(file)) {
        if is_there(c) {
            run(c, &["-std=c11", "-g"], &file, &[]);
        }
        if is_there(cpp) {
            run(cpp, &["-std=c++17", "-g", "-x", "c++"], &file, &[]);
        }
    }
}

#[test]
fn programs_in_c_and_in_cpp_do_what_they_should() {
    programs("cc", "c++");
}

/// Flags for C++, with Eigen where it is installed.
const CLASSES: [&str; 5] = [
    "-std=c++17",
    "-g",
    "-pthread",
    "-isystem",
    "/usr/include/eigen3",
];

/// Whether a compiler of C++ finds a header; says so if not.
fn has(compiler: &str, header: &str) -> bool {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("probe.cpp");
    fs::write(&file, format!("#include <{header}>\n")).unwrap();
    let mut probe = Command::new(compiler);
    probe.args(CLASSES).arg("-E").arg(file);
    let has = probe.output().is_ok_and(|ran| ran.status.success());
    if !has {
        eprintln!("skipped: {compiler} finds no {header}");
    }
    has
}

/// Compiles and runs the programs with classes, with schedulers of others where these are.
fn classes(compiler: &str) {
    if !is_there(compiler) {
        return;
    }
    let run = |file: &str, more: &[&str]| {
        run(
            compiler,
            &[&CLASSES, more].concat(),
            &root().join(file),
            &[],
        )
    };
    run("tests/world.cpp", &[]);
    run("tests/no_exceptions.cpp", &["-fno-exceptions"]);
    run("tests/threads.cpp", &[]);
    if has(compiler, "tbb/parallel_for.h") {
        let by_tbb = ["-DWITH_TBB", "-Wl,--no-as-needed", "-ltbb"];
        run("tests/threads.cpp", &by_tbb);
    }
    if has(compiler, "omp.h") {
        run("tests/threads.cpp", &["-fopenmp"]);
    }
    if has(compiler, "Eigen/Core") {
        run("tests/adapter.cpp", &["-O1", "-I", &stand_in()]);
    }
}

/// The folder that stands for ipc-toolkit's headers.
fn stand_in() -> String {
    root().join("tests/stand_in").display().to_string()
}

#[test]
fn classes_do_what_they_should() {
    classes("c++");
}

#[test]
#[ignore = "for releases: needs clang"]
fn another_compiler_takes_it_all() {
    programs("clang", "clang++");
    classes("clang++");
    let stand_in = stand_in();
    let flags = [&CLASSES[..], &["-I", &stand_in]].concat();
    let file = root().join("examples/ipc_lists.cpp");
    // Without arguments it says how it is called, and ends with 2.
    run("clang++", &flags, &file, &["sh", "-c", "$0 || test $? = 2"]);
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
            // Threads of a pool that is freed may still be ending.
            "--errors-for-leak-kinds=definite",
        ];
        run("cc", &["-std=c11", "-g"], &file, &valgrind);
    }
    for file in ["tests/world.cpp", "tests/threads.cpp", "tests/adapter.cpp"] {
        let stand_in = stand_in();
        let more = ["-fsanitize=address,undefined", "-I", &stand_in];
        let flags = [&CLASSES[..], &more].concat();
        run("c++", &flags, &root().join(file), &[]);
    }
    // The threads of C++ alone: the library is compiled without, so what it does is left out.
    let folder = tempfile::tempdir().unwrap();
    let left_out = folder.path().join("left_out");
    fs::write(&left_out, "called_from_lib:libpliant_c.so\n").unwrap();
    let options = format!("TSAN_OPTIONS=suppressions={}", left_out.display());
    let flags = [&CLASSES[..], &["-fsanitize=thread"]].concat();
    run(
        "c++",
        &flags,
        &root().join("tests/threads.cpp"),
        &["env", &options],
    );
}

#[test]
fn examples_say_what_they_should() {
    if is_there("cc") {
        let said = run(
            "cc",
            &["-std=c11", "-O1"],
            &root().join("examples/batch.c"),
            &[],
        );
        assert!(said.contains("of 100000 pairs meet; pair "), "{said}");
    }
    if is_there("c++") && has("c++", "Eigen/Core") {
        let said = cloth_on_ball("1");
        assert!(said.contains("1.00 s: cloth at 0.5"), "{said}");
    }
}

/// Output of the example after some seconds.
fn cloth_on_ball(seconds: &str) -> String {
    let file = root().join("examples/cloth_on_ball.cpp");
    let flags = [&CLASSES[..], &["-O1", "-ffp-contract=off"]].concat();
    run(
        "c++",
        &flags,
        &file,
        &["sh", "-c", &format!("$0 {seconds}")],
    )
}

#[test]
#[ignore = "for releases: compiles the example in Rust, too"]
fn the_cloth_on_the_ball_is_the_same_in_rust() {
    let mut example = Command::new(env!("CARGO"));
    example.args([
        "run",
        "-p",
        "pliant",
        "--example",
        "cloth_on_ball",
        "--",
        "3",
    ]);
    example.env("CARGO_TARGET_DIR", libraries().join("installed"));
    assert_eq!(succeeds(&mut example), cloth_on_ball("3"));
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
    let kinds = ["world_", "edit_", "changes_", "pool_"].map(|kind| format!("pliant_{kind}"));
    let methods = functions
        .into_iter()
        .filter(|it| kinds.iter().any(|kind| it.0.starts_with(kind)));
    let left: Vec<_> = methods.filter(|it| !is_called(it)).map(|it| it.0).collect();
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
