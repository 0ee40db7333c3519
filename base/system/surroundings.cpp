#include "base/system/surroundings.hpp"

#include <csignal>
#include <cstring>
#include <new>
#include <system_error>

#include <fmt/format.h>
#include <sys/wait.h>

namespace mpm {

bool is_of_surroundings(const std::exception& error) {
  return dynamic_cast<const SurroundingsFailure*>(&error) != nullptr ||
         dynamic_cast<const std::bad_alloc*>(&error) != nullptr ||
         dynamic_cast<const std::system_error*>(&error) != nullptr;
}

std::string what_happened(const std::exception& error) {
  const bool too_much =
      dynamic_cast<const std::bad_alloc*>(&error) != nullptr ||
      dynamic_cast<const std::length_error*>(&error) != nullptr;  // beyond any address space
  return too_much ? "not enough memory" : error.what();
}

ProcessEnd process_end(int status) {
  constexpr int kOfShell = 128;
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : code - kOfShell;
  return {WIFSIGNALED(status) ? fmt::format("ended by signal {} ({})", signal, ::strsignal(signal))
                              : fmt::format("ended with code {}", code),
          signal == SIGHUP || signal == SIGINT || signal == SIGKILL || signal == SIGTERM};
}

}  // namespace mpm
