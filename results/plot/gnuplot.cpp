#include "results/plot/gnuplot.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace mpm {
namespace {

std::string error_text(int code) {
  return std::error_code(code, std::generic_category()).message();
}

/// An empty folder that goes away with its owner.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "mpmbench-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw GnuplotError(
          fmt::format("{}: cannot make a temporary folder for gnuplot: {}", name, error_text(errno)));
    path_ = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  std::string operator/(const char* name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file)
    throw GnuplotError(fmt::format("{}: cannot write the script for gnuplot", path));
}

/// The files that a child process has as its standard streams.
class Redirection {
 public:
  Redirection(const std::string& out, const std::string& error) {
    ::posix_spawn_file_actions_init(&actions_);
    open(STDIN_FILENO, "/dev/null", O_RDONLY);
    open(STDOUT_FILENO, out, O_WRONLY | O_CREAT | O_TRUNC);
    open(STDERR_FILENO, error, O_WRONLY | O_CREAT | O_TRUNC);
  }
  Redirection(const Redirection&) = delete;
  Redirection& operator=(const Redirection&) = delete;
  ~Redirection() { ::posix_spawn_file_actions_destroy(&actions_); }

  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  void open(int descriptor, const std::string& path, int flags) {
    constexpr mode_t kOwner = 0600;
    ::posix_spawn_file_actions_addopen(&actions_, descriptor, path.c_str(), flags, kOwner);
  }

  posix_spawn_file_actions_t actions_{};
};

/// Starts the program and waits for its end; its wait status.
int run(std::string program, std::string script, const Redirection& streams) {
  std::string defaults = "-d";
  const std::array<char*, 4> words{program.data(), defaults.data(), script.data(), nullptr};
  pid_t child = 0;
  const int failure = ::posix_spawnp(&child, program.c_str(), streams.get(), nullptr, words.data(), environ);
  if (failure != 0)
    throw GnuplotError(fmt::format(
        "cannot start {}: {}; figures need it: install gnuplot (Debian: apt-get install gnuplot-nox)",
        program, error_text(failure)));
  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR)
      throw GnuplotError(fmt::format("cannot wait for {}: {}", program, error_text(errno)));
  return status;
}

/// What gnuplot says of its script, without the folder that is gone by the time somebody reads it.
std::string complaint(std::string text) {
  constexpr std::size_t kMost = 500;
  text.erase(text.find_last_not_of(" \n") + 1);
  text.erase(0, text.find_first_not_of(" \n"));
  return text.size() > kMost ? text.substr(0, kMost) + " ..." : text;
}

}  // namespace

std::string run_gnuplot(const std::string& script, const std::string& program) {
  const TemporaryFolder folder;
  const std::string script_file = folder / "script";
  const std::string out = folder / "out";
  const std::string error = folder / "error";
  write(script_file, script);
  const int status = run(program, script_file, Redirection(out, error));
  if (!WIFEXITED(status))
    throw GnuplotError(fmt::format("{} was ended by signal {}", program, WTERMSIG(status)));
  std::string drawing = content(out);
  if (WEXITSTATUS(status) != 0 || drawing.empty())
    throw GnuplotError(fmt::format("{} could not draw a figure (exit code {}): {}", program,
                                   WEXITSTATUS(status), complaint(content(error))));
  return drawing;
}

}  // namespace mpm
