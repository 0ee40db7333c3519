#include "bench/console/output.hpp"

#include <cstdio>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "results/files/utf8.hpp"

namespace mpm {

void print_result(std::string_view text) {
  const std::string plain = plain_text(text);
  std::fwrite(plain.data(), 1, plain.size(), stdout);  // the stream remembers an error
}

void print_note(std::string_view text) {
  const std::string plain = plain_text(text);
  std::fwrite(plain.data(), 1, plain.size(), stderr);
}

std::string how_to_go_on(std::string_view where, std::string_view command) {
  return fmt::format("\nFinished work is kept {}. To resume it:\n  {}", where, command);
}

std::string without_discard(std::string command_line) {
  constexpr std::string_view kDiscard = " --discard";
  if (const std::size_t place = command_line.rfind(kDiscard); place != std::string::npos)
    command_line.erase(place, kDiscard.size());
  return command_line;
}

std::string duration_text(double seconds) {
  return seconds < 120.0    ? fmt::format("{:.1f} s", seconds)
         : seconds < 7200.0 ? fmt::format("{:.0f} min", seconds / 60.0)
                            : fmt::format("{:.1f} h", seconds / 3600.0);
}

bool results_arrived() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0)
    return true;
  print_note(
      "mpmbench: stdout: the output is incomplete (disk full, stdout closed, or the reader is gone)\n");
  return false;
}

void occupy_closed_streams() {
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream)
    while (::fcntl(stream, F_GETFD) < 0 &&
           ::open("/dev/null", O_RDONLY) >= 0) {  // for reading only: writing fails
    }
}

}  // namespace mpm
