"""Checks that a file includes, itself or by what it includes of the project, where the names that it uses are declared.

A build reads several sources as one (CMAKE_UNITY_BUILD), so that the compiler does not notice what a source owes to
the one before it. This reads text and knows no C++: of the standard library the names below, of the project the types,
functions and constants that a header declares at the beginning of a line. A build of the preset debug, which compiles
each source by itself, is the whole proof.
"""

import re
from collections import defaultdict

import tree
from check_includes import includes

STANDARD = {
    "algorithm": "all_of any_of clamp copy count count_if fill find find_if lower_bound max max_element min minmax "
                 "min_element minmax_element none_of nth_element remove_if replace reverse rotate set_difference sort "
                 "stable_sort transform unique upper_bound",
    "array": "array",
    "atomic": "atomic",
    "charconv": "from_chars to_chars",
    "chrono": "chrono",
    "cmath": "atan cbrt ceil copysign cos erf exp expm1 floor fmod frexp hypot isfinite isinf isnan ldexp log log10 "
             "log1p lround nextafter pow remainder round sin sqrt tanh trunc",
    "condition_variable": "condition_variable",
    "cstdint": "int64_t int32_t uint64_t uint32_t uint16_t uint8_t",
    "exception": "current_exception exception_ptr rethrow_exception",
    "filesystem": "filesystem",
    "fstream": "ifstream ofstream",
    "functional": "function greater ref",
    "iomanip": "setprecision setw",
    "iostream": "cerr cout",
    "limits": "numeric_limits",
    "map": "map",
    "memory": "make_shared make_unique shared_ptr unique_ptr weak_ptr",
    "mutex": "lock_guard mutex once_flag scoped_lock unique_lock",
    "numeric": "accumulate iota",
    "optional": "nullopt optional",
    "set": "set",
    "span": "span",
    "sstream": "istringstream ostringstream stringstream",
    "stdexcept": "invalid_argument logic_error out_of_range runtime_error",
    "string": "getline stod stoi string to_string",
    "string_view": "string_view",
    "thread": "thread",
    "tuple": "tie tuple",
    "type_traits": "is_same_v",
    "utility": "exchange move pair swap",
    "variant": "holds_alternative variant visit",
    "vector": "vector",
}
HEADER_OF = {name: header for header, names in STANDARD.items() for name in names.split()}

# What brings another header with it, by the standard or by the use of everyone.
ALSO = {"iostream": ["string"], "sstream": ["string"], "fstream": ["string"], "map": ["utility"], "tuple": ["utility"]}

# Comments, characters and texts, raw ones too, say nothing of what is used.
SILENT = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', re.DOTALL)
STANDARD_NAME = re.compile(r"\bstd::(\w+)")
TYPE = re.compile(r"^(?:struct|class|enum class|using) (\w+)\b(?! ?;)", re.MULTILINE)
FUNCTION = re.compile(r"^(?!using|return|namespace|template)[A-Za-z][\w:<>,&* ]* [&*]?([a-z]\w*)\(", re.MULTILINE)
CONSTANT = re.compile(r"^(?:inline|extern) const(?:expr)? .*?\b(k[A-Z]\w*)", re.MULTILINE)
# A name behind a type or a word like `auto` or `struct`: a member, a nested type, a variable, a forward declaration.
LOCAL = re.compile(r"(?<![\w.>:])(?!return |else |throw |case |const )(?:[\w:]+|[\w:]+<.*>)[&*]* [&*]*(?=(\w+))")
CALL = re.compile(r"(?<![\w.>:~])(?:mpm::)?([a-z]\w*)\(")
CAPITALISED = re.compile(r"(?<![\w.])([A-Z]\w+|k[A-Z]\w*)\b")


class Files:
    """What the files of the project include, declare and use."""

    def __init__(self, root):
        self.text, self.direct, self.local = {}, {}, {}
        for path in tree.project_files(root, {".hpp", ".cpp"}):
            name = str(path.relative_to(root))
            self.text[name] = SILENT.sub('""', path.read_text(encoding="utf-8"))
            self.local[name] = set(LOCAL.findall(self.text[name]))
            self.direct[name] = [header for _, header, _ in includes(path)]
        self.declared_in = defaultdict(set)  # type or function -> headers of the project that declare it
        for name, text in self.text.items():
            if name.endswith(".hpp"):
                for declared in TYPE.findall(text) + FUNCTION.findall(text) + CONSTANT.findall(text):
                    self.declared_in[declared].add(name)

    def reached(self, name):
        """What `name` includes, and what the headers of the project among it include; `name` too."""
        found, waiting = set(), [name]
        while waiting:
            header = waiting.pop()
            if header not in found:
                found.add(header)
                waiting += self.direct.get(header, []) + ALSO.get(header, [])
        return found

    def complaints(self, name):
        text, reached = self.text[name], self.reached(name)
        for used in sorted(set(STANDARD_NAME.findall(text))):
            header = HEADER_OF.get(used)
            if header and header not in reached:
                yield f"{name}:1: std::{used} is used without <{header}>"
        known = set().union(*(self.local[one] for one in reached if one in self.local))
        for used in sorted(set(CAPITALISED.findall(text)) | set(CALL.findall(text))):
            headers = self.declared_in.get(used, set())
            if headers and used not in known and not headers & reached:
                yield f"{name}:1: {used} is used without {' or '.join(sorted(headers))}"


def check(root):
    files = Files(root)
    return [complaint for name in sorted(files.text) for complaint in files.complaints(name)]


if __name__ == "__main__":
    tree.main(check)
