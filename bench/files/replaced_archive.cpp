#include "bench/files/replaced_archive.hpp"

#include <exception>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "base/error.hpp"
#include "results/archive/archive.hpp"

namespace mpm {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& output, const std::string& found,
                         const std::string& allowed) {
  throw InputError(output.string(), found, allowed + ", another output, or --overwrite to replace it");
}

}  // namespace

void require_replaceable(const std::filesystem::path& output, const Study& study, Unreadable unreadable) {
  std::error_code error;  // what cannot be looked at is not there
  if (!std::filesystem::is_regular_file(output, error) || std::filesystem::file_size(output, error) == 0)
    return;
  Study there;
  try {
    there = stream_archive(output).study;
  } catch (const std::exception&) {  // also a study whose files are gone
    if (unreadable == Unreadable::kept)
      refuse(output, "a file that is not an archive of this program", "no file");
    return;
  }
  if (there.source != study.source)
    refuse(output,
           there.name == study.name ? fmt::format("an archive of {} with a different study text", there.name)
                                    : fmt::format("the archive of another study, {}", there.name),
           fmt::format("an archive of {} as it is now", study.name));
  if (there.seed != study.seed)
    refuse(output, fmt::format("the archive of {} with seed {}", there.name, there.seed),
           fmt::format("one with seed {}", study.seed));
}

}  // namespace mpm
