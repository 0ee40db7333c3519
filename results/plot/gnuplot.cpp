#include "results/plot/gnuplot.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/system/input_file.hpp"
#include "base/system/temporary_folder.hpp"
#include "results/files/utf8.hpp"

namespace mpm {
namespace {

std::string error_text(int code) {
  return std::error_code(code, std::generic_category()).message();
}

std::unique_ptr<TemporaryFolder> folder_for_gnuplot() {
  try {
    return std::make_unique<TemporaryFolder>();
  } catch (const std::system_error& error) {
    throw GnuplotError(fmt::format("cannot make a temporary folder for gnuplot: {}", error.what()));
  }
}

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return content_of(file);
}

void write(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file)
    throw GnuplotError(fmt::format("{}: cannot write the script for gnuplot", path));
}

/// The files that serve a child process as its standard streams.
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

/// Returns the environment without GNUTERM, in which a user names a terminal that this gnuplot may not have.
std::vector<char*> plain_environment() {
  std::vector<char*> kept;
  for (char** variable = environ; *variable != nullptr; ++variable)
    if (!std::string_view(*variable).starts_with("GNUTERM="))
      kept.push_back(*variable);
  kept.push_back(nullptr);
  return kept;
}

/// Waits for the end of a child and returns its wait status. Kills it if it has not ended after `patience`.
int end_of(pid_t child, const std::string& program, std::chrono::milliseconds patience) {
  constexpr std::chrono::milliseconds kLook(5);
  const auto until = std::chrono::steady_clock::now() + patience;
  for (;;) {
    int status = 0;
    const pid_t ended = ::waitpid(child, &status, WNOHANG);
    if (ended == child)
      return status;
    if (ended < 0 && errno != EINTR)
      throw GnuplotError(fmt::format("cannot wait for {}: {}", program, error_text(errno)));
    if (std::chrono::steady_clock::now() >= until)
      break;
    std::this_thread::sleep_for(kLook);
  }
  ::kill(child, SIGKILL);
  while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
  }
  throw GnuplotError(fmt::format("{} did not draw a figure within {} s", program,
                                 std::chrono::duration<double>(patience).count()));
}

/// Starts the program, waits for its end, and returns its wait status.
int run(std::string program, std::string script, const Redirection& streams,
        std::chrono::milliseconds patience) {
  std::string defaults = "-d";
  const std::array<char*, 4> words{program.data(), defaults.data(), script.data(), nullptr};
  const std::vector<char*> environment = plain_environment();
  pid_t child = 0;
  const int failure =
      ::posix_spawnp(&child, program.c_str(), streams.get(), nullptr, words.data(), environment.data());
  if (failure != 0)
    throw GnuplotError(
        fmt::format("cannot start {}: {}; figures need gnuplot (Debian: apt-get install gnuplot-nox)",
                    program, error_text(failure)));
  return end_of(child, program, patience);
}

/// Returns what gnuplot says about its script, trimmed and cut to a readable length.
std::string complaint(std::string text) {
  constexpr std::size_t kMost = 500;
  text.erase(text.find_last_not_of(" \n") + 1);
  text.erase(0, text.find_first_not_of(" \n"));
  return text.size() > kMost ? fmt::format("{} ...", cut_utf8(text, kMost)) : text;
}

}  // namespace

std::string run_gnuplot(const std::string& script, const std::string& program,
                        std::chrono::milliseconds patience) {
  const std::unique_ptr<TemporaryFolder> folder = folder_for_gnuplot();
  const std::string script_file = folder->path() / "script";
  const std::string out = folder->path() / "out";
  const std::string error = folder->path() / "error";
  write(script_file, script);
  const int status = run(program, script_file, Redirection(out, error), patience);
  if (!WIFEXITED(status))
    throw GnuplotError(fmt::format("{} was killed by signal {}", program, WTERMSIG(status)));
  std::string drawing = content(out);
  if (WEXITSTATUS(status) != 0 || drawing.empty())
    throw GnuplotError(fmt::format("{} could not draw a figure (exit code {}): {}", program,
                                   WEXITSTATUS(status), complaint(content(error))));
  return drawing;
}

}  // namespace mpm
