#include "plants/outside/fmu_library.hpp"

#include <cstddef>
#include <string_view>
#include <utility>

#include <dlfcn.h>
#include <fmt/format.h>

#include "base/system/foreign_text.hpp"
#include "base/system/forked_service.hpp"
#include "plants/outside/fmi2.hpp"

namespace mpm {
namespace {

std::string_view status_words(int status) {
  switch (status) {
    case fmi2::ok:
      return "ok";
    case fmi2::warning:
      return "warning";
    case fmi2::discard:
      return "discard: the step cannot be made, or not of this length";
    case fmi2::error:
      return "error";
    case fmi2::fatal:
      return "fatal error";
    case fmi2::pending:
      return "pending, which was not allowed";
    default:
      return "an unknown status";
  }
}

/// The last messages of the one FMU of this process. They are no member of an instance, because some FMUs
/// pass no environment to their logger.
struct FmuMessages {
  std::string any, of_trouble;
};

FmuMessages& messages() {
  static FmuMessages kept;
  return kept;
}

/// Loads the library so that its own symbols come first, which the sanitizers do not allow.
void* load_library(const std::string& path) {
#ifdef MPMBENCH_IS_SANITIZED
  constexpr int kOwnFirst = 0;
#else
  constexpr int kOwnFirst = RTLD_DEEPBIND;
#endif
  return ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | kOwnFirst);
}

}  // namespace

FmuLibrary::FmuLibrary(const FmuPackage& package, std::string prefix, std::string_view version)
    : prefix_(std::move(prefix)), library_(load_library(package.library())) {
  if (library_ == nullptr)
    throw ForeignFailure(fmt::format("its library cannot be loaded: {}", ::dlerror()));
  require_text("GetVersion", version);
}

void* FmuLibrary::symbol(const std::string& name) const {
  void* const found = ::dlsym(library_, (prefix_ + name).c_str());
  if (found == nullptr)
    throw ForeignFailure(fmt::format("its library has no function {}{}", prefix_, name));
  return found;
}

void FmuLibrary::require_text(const std::string& name, std::string_view text) const {
  constexpr std::size_t kShownOfAnswer = 100;  // bytes
  const char* const found = function<const char*()>(name)();
  if (found == nullptr || found != text)
    throw ForeignFailure(fmt::format(
        "{}{} of its library gives {}, not '{}'", prefix_, name,
        found == nullptr ? "nothing" : fmt::format("'{}'", foreign_text(found, kShownOfAnswer)), text));
}

void FmuLibrary::require(int status, const std::string& function, double now) const {
  if (status != fmi2::ok && status != fmi2::warning)
    throw ForeignFailure(
        fmt::format("{}{} at its time {}: {}{}", prefix_, function, now, status_words(status), said()));
}

void FmuLibrary::require_no_end(bool asks, const std::string& function, double now) const {
  if (asks)
    throw ForeignFailure(
        fmt::format("{}{} at its time {}: it asks to end{}", prefix_, function, now, said()));
}

std::string FmuLibrary::said() {
  const FmuMessages& kept = messages();
  const std::string& text = kept.of_trouble.empty() ? kept.any : kept.of_trouble;
  return text.empty() ? "" : fmt::format(" (it says: {})", text);
}

void FmuLibrary::keep(int status, const char* message) {
  if (message != nullptr)
    (status == fmi2::ok ? messages().any : messages().of_trouble) = message;
}

}  // namespace mpm
