"""Shows that each checker of this folder finds what it is for, and is silent about a clean tree."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import check_circles
import check_format
import check_hygiene
import check_includes
import check_link_order
import check_links
import check_paths
import check_quotes
import check_tidy
import check_used_names
import check_versions

HEADER = "#pragma once\n"


class Tree:
    """A scratch tree with the given files (path -> content)."""

    def __init__(self, files):
        self._folder = tempfile.TemporaryDirectory()
        self.root = Path(self._folder.name)
        for name, content in files.items():
            path = self.root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content if isinstance(content, bytes) else content.encode("utf-8"))

    def __enter__(self):
        return self.root

    def __exit__(self, *_):
        self._folder.cleanup()


class CheckerTest(unittest.TestCase):
    def complaints(self, checker, files):
        with Tree(files) as root:
            return checker.check(root)

    def assert_clean(self, checker, files):
        self.assertEqual(self.complaints(checker, files), [])

    def assert_one(self, checker, files, where, text):
        """Exactly one complaint, at this place and with this text."""
        complaints = self.complaints(checker, files)
        self.assertEqual(len(complaints), 1, complaints)
        self.assertTrue(complaints[0].startswith(where), complaints)
        self.assertIn(text, complaints[0])


class Quotes(CheckerTest):
    SOURCE = "int f() {\n  int a = 1;\n  int b = 2;\n  return a + b;\n}\n"

    def page(self, block, of="base/a.cpp"):
        return {"base/a.cpp": self.SOURCE, "a.md": f"# A\n\n<!-- quoted from {of} -->\n```cpp\n{block}```\n"}

    def test_what_stands_in_the_source(self):
        self.assert_clean(check_quotes, self.page("int f() {\n  int a = 1;\n...\n  return a + b;\n"))
        self.assert_clean(check_quotes, self.page("int a = 1;\nint b = 2;\n"))

    def test_what_does_not(self):
        for block in ("int f() {\n  int b = 2;\n", "return a + b;\n...\nint a = 1;\n", "int a = 2;\n", "...\nint a = 1;\n"):
            self.assert_one(check_quotes, self.page(block), "a.md:3", "not in base/a.cpp")
        self.assert_one(check_quotes, self.page("int a = 1;\n", of="base/b.cpp"), "a.md:3", "no file base/b.cpp")
        self.assert_one(check_quotes, {"a.md": "<!-- quoted from a.cpp -->\n\nNo block.\n"}, "a.md:1", "no block")


class Tidy(unittest.TestCase):
    FILES = {"plants/a.hpp": HEADER, "plants/a.cpp": '#include "plants/a.hpp"\n', "plants/only.hpp": HEADER,
             "plants/b.cpp": '#include "plants/only.hpp"\n', "bench/c.cpp": '#include "plants/only.hpp"\n'}

    def sources(self, root, changed):
        flags = {str(root / name): ["-O2"] for name in self.FILES if name.endswith(".cpp")}
        return check_tidy.sources_of(root, changed, flags)

    def test_a_changed_header_is_read_through_one_source(self):
        with Tree(self.FILES) as root:
            self.assertEqual(self.sources(root, {"plants/a.hpp", "docs/page.md"}), ["plants/a.cpp"])
            self.assertEqual(self.sources(root, {"plants/only.hpp"}), ["bench/c.cpp"])
            self.assertEqual(self.sources(root, {"bench/c.cpp", "plants/gone.cpp"}), ["bench/c.cpp"])
            self.assertEqual(self.sources(root, set()), [])

    def test_every_source_is_read_when_what_has_changed_is_not_known(self):
        with Tree(self.FILES) as root:
            self.assertIsNone(check_tidy.changed_files(root))
            self.assertEqual(len(self.sources(root, None)), 3)

    def test_files_of_the_work_tree_differ_from_the_commit_that_was_clean(self):
        with Tree({"plants/a.cpp": "\n", ".ci/tidied": "", ".clang-tidy": "\n"}) as root:
            def git(*words):
                return subprocess.run(["git", "-C", str(root), "-c", "user.name=a", "-c", "user.email=a@b", *words],
                                      check=True, capture_output=True, text=True).stdout
            git("init", "-q")
            git("add", "-A")
            git("commit", "-qm", "clean")
            (root / ".ci/tidied").write_text(git("rev-parse", "HEAD"), encoding="utf-8")
            (root / "plants/a.cpp").write_text("int a;\n", encoding="utf-8")
            (root / "plants/new.cpp").write_text("int b;\n", encoding="utf-8")
            self.assertEqual(check_tidy.changed_files(root), {".ci/tidied", "plants/a.cpp", "plants/new.cpp"})
            (root / ".clang-tidy").write_text("Checks: -*\n", encoding="utf-8")
            self.assertIsNone(check_tidy.changed_files(root))
            (root / ".ci/tidied").write_text("0" * 40, encoding="utf-8")
            self.assertIsNone(check_tidy.changed_files(root))


class Paths(CheckerTest):
    def test_files_folders_names_without_suffix_and_stars_are_found(self):
        self.assert_clean(check_paths, {
            "plants/fast/a.cpp": "// plants/fast, plants/fast/a.cpp, plants/fast/a, plants/fast/*.cpp and b.hpp\n",
            "plants/b.hpp": HEADER,
            "docs/page.md": "See plants/fast/a (and NAME_method.cpp), but not ../plants/gone or that/plants/gone.\n"})

    def test_a_path_that_is_not_there_is_found_in_comments_and_documents(self):
        self.assert_one(check_paths, {"plants/a.hpp": HEADER + "/// As plants/gone has it.\n"}, "plants/a.hpp:2:", "plants/gone")
        self.assert_one(check_paths, {"docs/page.md": "Read plants/gone.hpp.\n"}, "docs/page.md:1:", "plants/gone.hpp")
        self.assert_one(check_paths, {"tests/a.py": '"""About plants/gone*."""\n'}, "tests/a.py:1:", "plants/gone*")

    def test_a_header_that_no_folder_has_is_found(self):
        self.assert_one(check_paths, {"plants/a.hpp": HEADER + "// the list of gone.hpp\n"}, "plants/a.hpp:2:", "gone.hpp")

    def test_code_is_not_read(self):
        self.assert_clean(check_paths, {"plants/a.cpp": 'const char* x = "plants/gone";\n'})


class Includes(CheckerTest):
    def test_own_room_and_rooms_to_the_left_are_allowed(self):
        self.assert_clean(check_includes, {
            "plants/a.hpp": HEADER,
            "solvers/b.hpp": '#include <vector>\n#include "plants/a.hpp"\n',
            "solvers/b.cpp": '#include "solvers/b.hpp"\n'})

    def test_a_room_to_the_right_is_refused(self):
        self.assert_one(check_includes, {"plants/a.cpp": '\n#  include "solvers/b.hpp"\n', "solvers/b.hpp": HEADER},
                        "plants/a.cpp:2:", "plants must not include solvers")

    def test_each_room_refuses_the_next_one(self):
        for left, right in zip(check_includes.tree.ROOMS, check_includes.tree.ROOMS[1:]):
            self.assert_one(check_includes, {f"{left}/a.cpp": f'#include "{right}/b.hpp"\n', f"{right}/b.hpp": HEADER},
                            f"{left}/a.cpp:1:", f"{left} must not include {right}")

    def test_each_folder_refuses_the_next_one(self):
        for room, folders in check_includes.tree.FOLDERS.items():
            for left, right in zip(folders, folders[1:]):
                left, right = (f"{room}/{folder}".rstrip("/") for folder in (left, right))  # "": the folder itself
                self.assert_one(check_includes, {f"{left}/a.cpp": f'#include "{right}/b.hpp"\n', f"{right}/b.hpp": HEADER},
                                f"{left}/a.cpp:1:", f"{left} must not include {right}")
                self.assert_clean(check_includes, {f"{right}/a.cpp": f'#include "{left}/b.hpp"\n', f"{left}/b.hpp": HEADER})

    def test_a_folder_without_a_place_in_the_order_is_refused(self):
        self.assert_one(check_includes, {"results/odd/a.cpp": '#include "results/odd/b.hpp"\n',
                                         "results/odd/b.hpp": HEADER},
                        "results/odd/a.cpp:1:", "no folder of tree.FOLDERS")

    def test_tests_include_everything_but_are_included_by_no_room(self):
        self.assert_clean(check_includes, {
            "bench/b.hpp": HEADER, "tests/t.hpp": HEADER,
            "tests/plants/t.cpp": '#include "bench/b.hpp"\n#include "tests/t.hpp"\n'})
        self.assert_one(check_includes, {"bench/b.cpp": '#include "tests/t.hpp"\n', "tests/t.hpp": HEADER},
                        "bench/b.cpp:1:", "does not start with a room")

    def test_a_path_that_is_not_from_the_root_is_refused(self):
        self.assert_one(check_includes, {"plants/a.cpp": '#include "a.hpp"\n', "plants/a.hpp": HEADER},
                        "plants/a.cpp:1:", "does not start with a room")

    def test_an_own_header_in_angle_brackets_is_refused(self):
        self.assert_one(check_includes, {"plants/a.cpp": "#include <plants/a.hpp>\n", "plants/a.hpp": HEADER},
                        "plants/a.cpp:1:", "belongs in quotes")

    def test_a_header_that_is_not_there_is_refused(self):
        self.assert_one(check_includes, {"plants/a.cpp": '#include "plants/gone.hpp"\n'},
                        "plants/a.cpp:1:", "does not exist")

    def test_the_own_header_belongs_first(self):
        files = {"plants/a.hpp": HEADER, "plants/b.hpp": HEADER}
        own, other = '#include "plants/a.hpp"\n', '#include "plants/b.hpp"\n'
        self.assert_clean(check_includes, {**files, "plants/a.cpp": own + other})
        self.assert_one(check_includes, {**files, "plants/a.cpp": other + own}, "plants/a.cpp:1:",
                        '"plants/a.hpp" belongs first')
        self.assert_one(check_includes, {"tests/plants/a.hpp": HEADER, "tests/plants/a.cpp": "#include <map>\n"},
                        "tests/plants/a.cpp:1:", '"tests/plants/a.hpp" belongs first')

    def test_a_confined_library_stands_in_one_source(self):
        for header in ("coin/IpTNLP.hpp", "IpIpoptApplication.hpp", "hdf5.h", "hdf5_hl.h", "cvode/cvode.h"):
            line = f"#include <{header}>\n"
            self.assert_clean(check_includes, {"solvers/a.cpp": line + line})
            self.assert_one(check_includes, {"solvers/a.hpp": line}, "solvers/a.hpp:1:", "in a header")
            two = self.complaints(check_includes, {"solvers/a.cpp": line, "solvers/b.cpp": line})
            self.assertEqual(len(two), 2, two)
            self.assertIn("included in 2 sources", two[0])

    def test_a_wrapper_of_several_files_keeps_its_library_to_itself(self):
        wrapper = {"results/archive/hdf5_a.hpp": HEADER + "#include <hdf5.h>\n",
                   "results/archive/hdf5_b.hpp": HEADER + '#include "results/archive/hdf5_a.hpp"\n',
                   "results/archive/hdf5_b.cpp": '#include "results/archive/hdf5_b.hpp"\n#include <hdf5_hl.h>\n',
                   "results/archive/hdf5_open.hpp": HEADER}
        user = {"results/archive/c.cpp": '#include "results/archive/hdf5_open.hpp"\n'}
        self.assert_clean(check_includes, {**wrapper, **user})
        user["results/archive/c.cpp"] += '#include "results/archive/hdf5_b.hpp"\n'
        self.assert_one(check_includes, {**wrapper, **user}, "results/archive/c.cpp:2:", "is for results/archive/hdf5_* only")

    def test_sources_outside_of_the_rooms_are_refused(self):
        self.assert_one(check_includes, {"tools/a.cpp": ""}, "tools/a.cpp:1:", "outside of the rooms")

    def test_the_build_tree_is_not_looked_at(self):
        self.assert_clean(check_includes, {"build/release/x.cpp": '#include "a.hpp"\n'})


class Circles(CheckerTest):
    CHAIN = {"plants/a.hpp": '#include "plants/b.hpp"\n', "plants/b.hpp": HEADER, "plants/c.cpp": '#include "plants/a.hpp"\n'}

    def test_a_header_and_its_source_are_one(self):
        self.assert_clean(check_circles, self.CHAIN)
        self.assert_clean(check_circles, self.CHAIN | {"plants/a.cpp": '#include "plants/a.hpp"\n'})
        self.assert_one(check_circles, self.CHAIN | {"plants/b.cpp": '#include "plants/b.hpp"\n#include "plants/a.hpp"\n'},
                        "plants/a.hpp:1:", "a circle of plants/a, plants/b")

    def test_a_circle_of_more_than_two(self):
        self.assert_one(check_circles, self.CHAIN | {"plants/b.hpp": '#include "plants/c.hpp"\n',
                                                     "plants/c.hpp": '#include "plants/a.hpp"\n'},
                        "plants/a.hpp:1:", "a circle of plants/a, plants/b, plants/c")

    def test_modules_of_the_package(self):
        modules = {"python/mpmbench/a.py": "from . import b\n", "python/mpmbench/b.py": "import json\n"}
        self.assert_clean(check_circles, modules)
        self.assert_one(check_circles, modules | {"python/mpmbench/b.py": "from .a import name\n"},
                        "python/mpmbench/a.py:1:", "a circle of a, b")

    def test_a_function_hides_no_import(self):
        self.assert_one(check_circles, {"python/mpmbench/a.py": "def f():\n    from .b import name\n"},
                        "python/mpmbench/a.py:2:", "the import of b is hidden in a function")
        self.assert_one(check_circles, {"python/mpmbench/a.py": "class A:\n    import mpmbench.b\n"},
                        "python/mpmbench/a.py:2:", "the import of b is hidden in a function")
        self.assert_clean(check_circles, {"python/mpmbench/a.py": "def f():\n    import pandas\n"})


class LinkOrder(unittest.TestCase):
    def complaints(self, sources):
        """Of a build in which every room has one object: source text by room, nothing in the others."""
        with Tree({f"{room}/source.cpp": sources.get(room, "") for room in check_link_order.tree.ROOMS}) as build:
            for room in check_link_order.tree.ROOMS:
                subprocess.run([os.environ["CXX"], "-c", build / room / "source.cpp", "-o", build / room / f"libmpm_{room}.a"],
                               check=True)
            return check_link_order.check(build)

    def test_a_room_takes_from_its_left_alone(self):
        needs, defines = "void f(int);\nvoid g() { f(1); }\n", "void f(int) {}\n"
        self.assertEqual(self.complaints({"plants": defines, "solvers": needs}), [])
        self.assertEqual(self.complaints({"plants": needs, "solvers": defines}), ["plants: needs f(int), which solvers defines"])

    def test_what_a_room_has_itself_may_be_elsewhere_too(self):
        inline = "inline void f(int) {}\nvoid %s() { f(1); }\n"
        self.assertEqual(self.complaints({"plants": inline % "g", "solvers": inline % "h"}), [])

    def test_a_build_without_libraries_is_no_proof(self):
        with Tree({}) as build:
            self.assertEqual(len(check_link_order.check(build)), len(check_link_order.tree.ROOMS))


class UsedNames(CheckerTest):
    HEADER = HEADER + "struct Row {\n  int size;\n};\nint row_count(const Row& row);\n"

    def assert_missing(self, source, text, **more):
        self.assert_one(check_used_names, {"base/row.hpp": self.HEADER, "plants/b.cpp": source, **more},
                        "plants/b.cpp:1:", text)

    def test_what_is_included_itself_or_by_a_header_of_the_project_is_there(self):
        self.assert_clean(check_used_names, {
            "base/row.hpp": self.HEADER,
            "plants/a.hpp": HEADER + '#include <vector>\n#include "base/row.hpp"\n',
            "plants/b.cpp": '#include "plants/a.hpp"\nint f(std::vector<Row> rows) { return row_count(rows[0]); }\n'})

    def test_a_name_of_the_standard_library_without_its_header(self):
        self.assert_missing("#include <vector>\nauto f(int* p) { return std::move(p); }\n", "std::move is used without <utility>")

    def test_a_type_of_the_project_without_its_header(self):
        self.assert_missing("int f(Row& row);\n", "Row is used without base/row.hpp")
        self.assert_missing("int f(const Row& row);\n", "Row is used without base/row.hpp")

    def test_a_function_of_the_project_without_its_header(self):
        self.assert_missing("int f() { return row_count({}); }\n", "row_count is used without base/row.hpp")

    def test_comments_texts_and_names_of_its_own_use_nothing(self):
        self.assert_clean(check_used_names, {
            "base/row.hpp": self.HEADER,
            "plants/b.cpp": 'struct Row;  // std::vector\nconst char* f(Row& one) { return "std::move row_count("; }\n',
            "plants/c.cpp": "int f() {\n  const auto row_count = [] { return 1; };\n  return row_count();\n}\n"})


class Format(CheckerTest):
    STYLE = {".clang-format": "BasedOnStyle: Google\n"}

    def test_clean(self):
        self.assert_clean(check_format, {**self.STYLE, "plants/a.cpp": "int a = 1;\n"})

    def test_a_badly_formatted_file(self):
        self.assert_one(check_format, {**self.STYLE, "plants/a.cpp": "int a =  1;\n", "plants/b.cpp": "int b = 1;\n"},
                        "plants/a.cpp:1:", "should be clang-formatted")

    def test_a_broken_style_file_is_reported(self):
        self.assertTrue(self.complaints(check_format, {".clang-format": "Nonsense: 1\n", "plants/a.cpp": "int a;\n"}))


class Hygiene(CheckerTest):
    def test_clean(self):
        self.assert_clean(check_hygiene, {"plants/a.hpp": HEADER, "docs/a.md": "25 \u00b0C\n", "a.h5": b"\0\xff"})

    def test_a_path_of_a_machine(self):
        for path in ("/ho" "me/somebody/x", "/wo" "rk/main", "/tmp/bu" "ild-x", "/ro" "ot/x"):
            self.assert_one(check_hygiene, {"docs/a.md": f"\nsee `{path}`\n"}, "docs/a.md:2:", "path of a machine")

    def test_the_end_of_a_relative_path_is_no_path_of_a_machine(self):
        self.assert_clean(check_hygiene, {"docs/a.md": "docs/ho" "me/x and ./wo" "rk/x\n"})

    def test_a_left_over_marker(self):
        for marker in ("TO" "DO", "FIX" "ME", "XX" "X", "HA" "CK"):
            self.assert_one(check_hygiene, {"plants/a.cpp": f"// {marker}: later\n"}, "plants/a.cpp:1:", marker)

    def test_a_header_without_guard(self):
        self.assert_one(check_hygiene, {"plants/a.hpp": "int f();\n"}, "plants/a.hpp:1:", "#pragma once")

    def test_a_script_in_a_source(self):
        def source(lines):
            return "\nconst char* const kText = R\"js(\n" + lines * "f();\n" + ")js\";\n"
        self.assert_one(check_hygiene, {"results/a.cpp": source(40)}, "results/a.cpp:2:", "text of 41 lines: a file for mpm_embed")
        self.assert_clean(check_hygiene, {"results/a.cpp": source(20), "tests/a.cpp": source(40)})

    def test_not_ascii_in_a_source(self):
        self.assert_one(check_hygiene, {"plants/a.cpp": "// \u03c4\n"}, "plants/a.cpp:1:", "not ASCII: '\\u03c4'")

    def test_not_utf8(self):
        self.assert_one(check_hygiene, {"docs/a.md": b"\xff\n"}, "docs/a.md:1:", "not UTF-8")


class Links(CheckerTest):
    PAGE = "# Page\n\n## The `key[]` of it\n\n```sh\n# no heading\n```\n"

    def test_clean(self):
        self.assert_clean(check_links, {"docs/a.md": self.PAGE, "docs/b.md": "[a](a.md#the-key-of-it), [p](../x.cpp)\n"
                                        "[top](#b) [web](https://example.org/none)\n```\n[c](none.md)\n```\n# B\n",
                                        "x.cpp": ""})

    def test_what_is_not_there(self):
        for link, text in (("none.md", "no such file"), ("a.md#key", "no such heading"), ("a.md#no-heading", "no such heading"),
                           ("#b", "no such heading")):
            self.assert_one(check_links, {"docs/a.md": self.PAGE, "docs/b.md": f"\n[a]({link})\n"}, "docs/b.md:2:", text)


class Tidy(CheckerTest):
    """The project's own .clang-tidy, in a scratch tree."""

    CONFIGURATION = (Path(__file__).parents[2] / ".clang-tidy").read_text(encoding="utf-8")
    COPIED_FOR_NOTHING = ("#include <string>\n#include <vector>\ninline int f(const std::vector<std::string>& texts) {\n"
                          "  int n = 0;\n  for (const auto text : texts)\n    n += static_cast<int>(text.size());\n"
                          "  return n;\n}\n")

    def run_tidy(self, files, source):
        with Tree({".clang-tidy": self.CONFIGURATION, **files}) as root:
            command = [os.environ.get("CLANG_TIDY", "clang-tidy"), "--quiet", source, "--", "-std=c++20", f"-I{root}"]
            return subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)

    def test_clean(self):
        result = self.run_tidy({"plants/a.cpp": "int f() { return 1; }\n"}, "plants/a.cpp")
        self.assertEqual(result.returncode, 0, result.stdout)

    def test_a_complaint_about_a_source_is_an_error(self):
        result = self.run_tidy({"plants/a.cpp": self.COPIED_FOR_NOTHING}, "plants/a.cpp")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("performance-for-range-copy", result.stdout)

    def test_a_complaint_about_a_header_is_an_error(self):
        result = self.run_tidy({"plants/a.hpp": HEADER + self.COPIED_FOR_NOTHING,
                                "plants/a.cpp": '#include "plants/a.hpp"\n'}, "plants/a.cpp")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("plants/a.hpp", result.stdout)


class Versions(CheckerTest):
    TREE = {"CMakeLists.txt": "project(mpmbench\n  VERSION 1.2.3\n", "CITATION.cff": "version: 1.2.3\ndate-released: 2026-01-02\n",
            "python/mpmbench/version.py": '__version__ = "1.2.3"\n', "CHANGELOG.md": "## [Unreleased]\n\n## [1.2.3] - 2026-01-02\n"}

    def test_clean(self):
        self.assert_clean(check_versions, {**self.TREE, "docs/a.md": "since mpmbench 1.2.3"})

    def test_every_place_is_compared(self):
        for place in ("CITATION.cff", "python/mpmbench/version.py", "CHANGELOG.md"):
            self.assert_one(check_versions, {**self.TREE, place: self.TREE[place].replace("1.2.3", "1.2.2")}, place, "1.2.2")

    def test_the_day_is_that_of_the_changelog(self):
        self.assert_one(check_versions, {**self.TREE, "CITATION.cff": "version: 1.2.3\ndate-released: 2026-01-03\n"},
                        "CITATION.cff", "2026-01-03")

    def test_a_place_without_a_version_is_a_complaint(self):
        self.assert_one(check_versions, {**self.TREE, "python/mpmbench/version.py": "\n"}, "python/mpmbench/version.py", "found none")

    def test_no_document_names_the_file_of_a_package(self):
        self.assert_one(check_versions, {**self.TREE, "docs/a.md": "install ./mpmbench_1.2.3_amd64.deb\n"}, "docs/a.md:1", "mpmbench_1.2.3")


class Main(CheckerTest):
    def exit_code(self, files):
        with Tree(files) as root:
            arguments, sys.argv = sys.argv, ["checker", str(root)]
            try:
                check_hygiene.tree.main(check_hygiene.check)
            except SystemExit as exit_:
                return exit_.code
            finally:
                sys.argv = arguments
        return None

    def test_exit_code(self):
        self.assertEqual(self.exit_code({"plants/a.hpp": HEADER}), 0)
        self.assertEqual(self.exit_code({"plants/a.hpp": ""}), "1 complaints")  # a text: Python exits with 1


if __name__ == "__main__":
    unittest.main()
