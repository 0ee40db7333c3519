#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/methods/method_file.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"
#include "base/system/child_process.hpp"
#include "base/system/program_trust.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/console/output.hpp"
#include "bench/files/new_file.hpp"

namespace mpm {
namespace {

// {0} is the name of the method in both, {1} in Python the folder of the package.

constexpr std::string_view kPythonMethod =
    R"("""{0}: a method of assessment for mpmbench, by the Python package mpmbench (docs/python.md).

    mpmbench compare ARCHIVE.h5 --method-file {0}.toml

In a notebook: mpmbench.open("ARCHIVE.h5").compare(assess).
"""

import sys

import numpy

sys.path.append({1:?})  # of the mpmbench that wrote this file; a package that is installed comes before
import mpmbench  # noqa: E402


def mean_squares(loop):
    """Mean square of the error of the model of each CV; missing samples do not count."""
    return numpy.nanmean((loop.y - loop.y_sim) ** 2, axis=1)


@mpmbench.method(name="{0}", needs=["benchmark"], answers=["cv"])
def assess(loop, *, threshold=1.5):
    """The errors of the model are larger than in the benchmark: put your own indicator in its place."""
    ratio = mean_squares(loop) / mean_squares(loop.benchmark)
    return {{"flagged": ratio.max() > threshold, "score": ratio.max(), "cv": loop.cvs[ratio.argmax()]}}


if __name__ == "__main__":
    mpmbench.serve(assess)
)";

constexpr std::string_view kOctaveMethod =
    R"(% {0}: a method of assessment for mpmbench, by the Octave package +mpmbench (docs/python.md).
%
%   mpmbench compare ARCHIVE.h5 --method-file {0}.toml

1;  % a script, which defines functions

function squares = mean_squares (loop)
  % Mean square of the error of the model of each CV.
  squares = mean ((loop.y - loop.y_sim) .^ 2, 2);
end

function answer = assess (loop, context, options)
  % Put your own indicator in the place of this one.
  ratio = mean_squares (loop) ./ mean_squares (context.benchmark);
  [answer.score, worst] = max (ratio);
  answer.flagged = answer.score > options.threshold;
  answer.cv = context.cvs(worst).name;
end

description.title = "{0}";
description.verdict = "the errors of the model are larger than in the benchmark";
description.needs = {{"benchmark", "complete_record"}};
description.answers = {{"cv"}};
mpmbench.serve (@assess, description);
)";

/// The folder of +mpmbench: beside the studies of an installed program, or in its source tree.
std::filesystem::path octave_folder() {
  const std::filesystem::path data = study_directory().parent_path();
  std::error_code error;
  return std::filesystem::is_directory(data / "octave", error) ? data / "octave"
                                                               : data.parent_path() / "octave";
}

/// The folder of the Python package: that of an installed program, or of its source tree.
std::filesystem::path python_folder() {
  const std::filesystem::path root = study_directory().parent_path().parent_path(), tree = root / "python";
  std::error_code error;
  return std::filesystem::is_directory(tree / "mpmbench", error)
             ? tree
             : root.parent_path() / "lib/python3/dist-packages";
}

/// The command that runs a method in the language of this file; empty if the language is unknown.
std::vector<std::string> command_of(const std::filesystem::path& file) {
  if (file.extension() == ".py")
    return {"python3", file.string()};
  if (file.extension() == ".m")
    return {"octave-cli", "--norc", "--quiet", "--no-gui", "--path", octave_folder().string(), file.string()};
  return {};
}

/// A command that prints 1 if the language of the file has a module or function of this name, otherwise 0.
std::vector<std::string> question_of(const std::filesystem::path& file, const std::string& name) {
  if (file.extension() == ".py")
    return {"python3", "-I", "-c",
            "import importlib.util, sys; print(int(importlib.util.find_spec(sys.argv[1]) is not None))",
            name};
  return {"octave-cli", "--norc",
          "--quiet",    "--no-gui",
          "--eval",     fmt::format("printf ('%d\\n', any (exist ('{}') == [2, 3, 5, 103]))", name)};
}

/// Refuses a file that would hide a module of Python or a function of Octave: code that imports or calls that
/// would get the method instead.
void require_unknown_name(const std::filesystem::path& file, const std::string& name) {
  constexpr double kPatience = 20.0;  // s
  const std::vector<std::string> question = question_of(file, name);
  trust_program(question);
  try {
    ChildProcess program(question);
    if (program.receive(ChildProcess::in_seconds(kPatience)) != "1")
      return;
  } catch (const ChildFailure&) {  // the language is not installed: the name cannot be checked
    return;
  }
  throw InputError("FILE",
                   fmt::format("'{}', the name of a {}, which the file would hide from its users", name,
                               file.extension() == ".py" ? "module of Python" : "function of Octave"),
                   "another name");
}

ExitCode init_method(const std::filesystem::path& file) {
  const std::vector<std::string> command = command_of(file);
  if (command.empty())
    throw InputError("FILE", fmt::format("'{}'", file.string()), "NAME.py or NAME.m");
  const std::string name = name_of_file(file);
  if (!is_method_name(name))
    throw InputError("FILE", fmt::format("'{}'", name), kMethodNameRule);
  const std::vector<std::string> ours = shipped_methods().names();
  if (shipped_methods().has(name))
    throw InputError("FILE", fmt::format("the name of the method {}", name),
                     fmt::format("a name that is not one of {}", fmt::join(ours, ", ")));
  const std::filesystem::path table = std::filesystem::path(file).replace_extension(".toml");
  require_new(file);
  require_unknown_name(file, name);
  write_new(table, fmt::format("# A method that is a program (docs/bring_your_own.md).\n\n[method.{}]\n"
                               "command = [{:?}]\n"
                               "time_limit = 60                 # seconds for an answer\n"
                               "options = {{threshold = 1.5}}     # given to the function\n",
                               name, fmt::join(command, ", ")));
  write_new(file, fmt::format(fmt::runtime(file.extension() == ".py" ? kPythonMethod : kOctaveMethod), name,
                              python_folder().string()));
  print_result(
      fmt::format("{0}, {1}: fill in the function `assess`, then:\n"
                  "  mpmbench suite quick --method-file {1} -o {2}-on-the-board\n"
                  "  mpmbench compare ARCHIVE.h5 --method-file {1}\n",
                  file.string(), table.string(), name));
  return ExitCode::done;
}

}  // namespace

void add_init_method(CommandSet& commands) {
  const auto file = std::make_shared<std::string>();
  CLI::App& app = commands.add("init-method",
                               "Write a method of your own in Python or Octave, with one function to fill in",
                               [file] { return init_method(*file); });
  add_path(app, "FILE", *file,
           "Method to write, NAME.py or NAME.m; NAME.toml, the file that --method-file takes, is written "
           "beside it")
      ->required();
}

}  // namespace mpm
