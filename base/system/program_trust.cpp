#include "base/system/program_trust.hpp"

#include <mutex>
#include <set>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/system/foreign_text.hpp"

namespace mpm {
namespace {

constexpr std::size_t kShownOfCommand = 500;  // bytes of a command line or a path

class Trust {
 public:
  void add(const std::vector<std::string>& words) {
    const std::lock_guard lock(mutex_);
    trusted_.insert(words);
  }
  void add_all() {
    const std::lock_guard lock(mutex_);
    all_ = true;
  }
  bool has(const std::vector<std::string>& words) const {
    const std::lock_guard lock(mutex_);
    return all_ || trusted_.count(words) > 0;
  }

 private:
  mutable std::mutex mutex_;
  std::set<std::vector<std::string>> trusted_;
  bool all_ = false;
};

/// There is one per process, like the programs that it allows.
Trust& trust() {
  static Trust one;
  return one;
}

/// The first word distinguishes a file from a command of the same name.
std::vector<std::string> words_of(const std::filesystem::path& fmu) {
  std::error_code no_status;
  const std::filesystem::path whole = std::filesystem::weakly_canonical(fmu, no_status);
  return {"FMU", (no_status ? fmu : whole).string()};
}

void require_trust(const std::vector<std::string>& words, const char* what, const std::string& shown) {
  if (!trust().has(words))
    throw UntrustedProgram(
        fmt::format("found {} `{}` in a study that is not from a file of yours; allowed: only with "
                    "--trust-programs, if you trust the author of the archive",
                    what, foreign_text(shown, kShownOfCommand)));
}

}  // namespace

void trust_program(const std::vector<std::string>& command) {
  trust().add(command);
}

void trust_fmu(const std::filesystem::path& file) {
  trust().add(words_of(file));
}

void trust_every_program() {
  trust().add_all();
}

void require_trusted_program(const std::vector<std::string>& command) {
  require_trust(command, "the program", fmt::format("{}", fmt::join(command, " ")));
}

void require_trusted_fmu(const std::filesystem::path& file) {
  require_trust(words_of(file), "the FMU", file.string());
}

}  // namespace mpm
