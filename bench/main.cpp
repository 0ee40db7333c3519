#include <csignal>
#include <cstdlib>
#include <string>

#include <unistd.h>

#include "bench/commands.hpp"
#include "bench/options.hpp"

namespace {

/// The BLAS under Ipopt must not start threads: they would compete with the workers, and the workers are
/// forked from this process. It reads its environment when it is loaded, so the program starts itself once
/// more.
void use_single_threaded_blas(char** argv) {
  if (std::getenv("OPENBLAS_NUM_THREADS") != nullptr)
    return;
  ::setenv("OPENBLAS_NUM_THREADS", "1", 1);
  ::execv("/proc/self/exe", argv);  // returns only when it fails: then go on as we are
}

/// A word as a shell reads it back.
std::string quoted(const std::string& word) {
  constexpr const char* kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./,:=+@%-";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos)
    return word;
  std::string text = "'";
  for (const char c : word)
    text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string joined(int argc, const char* const* argv) {
  std::string line = "mpmbench";
  for (int i = 1; i < argc; ++i)
    line.append(" ").append(quoted(argv[i]));
  return line;
}

}  // namespace

int main(int argc, char** argv) {
  use_single_threaded_blas(argv);
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit of its size is an error of write(), with a text
  return static_cast<int>(mpm::execute(mpm::parse_command_line(argc, argv), joined(argc, argv)));
}
