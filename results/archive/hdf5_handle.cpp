#include "results/archive/hdf5_handle.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "results/files/archive_error.hpp"

namespace mpm::hdf5 {

std::string last_error() {
  std::string text;
  const auto keep = [](unsigned, const H5E_error2_t* error, void* data) -> herr_t {
    auto& kept = *static_cast<std::string*>(data);
    if (kept.empty() && error->desc != nullptr)
      kept = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep, &text);
  return text.empty() ? "" : fmt::format(" ({})", text);
}

void silence_library() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

void Place::fail(const std::string& problem) const {
  throw ArchiveError(fmt::format("{}: {} '{}{}': {}", file, what, parent, name, problem));
}

void Place::refuse(const std::string& found, const std::string& allowed) const {
  throw InputError(fmt::format("{}: {} '{}{}'", file, what, parent, name), found, allowed);
}

void Place::check(herr_t result, const char* action) const {
  if (result < 0)
    fail(fmt::format("cannot {}{}", action, last_error()));
}

Handle Place::own(hid_t id, Handle::Close close, const char* action) const {
  if (id < 0)
    fail(fmt::format("cannot {}{}", action, last_error()));
  return {id, close};
}

}  // namespace mpm::hdf5
