#include "base/system/loaded_code.hpp"

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

namespace mpm {
namespace {

constexpr std::size_t kAlignment = 4;  // bytes; of the parts of a note

std::size_t aligned_note(std::size_t size) {
  return (size + kAlignment - 1) / kAlignment * kAlignment;
}

/// The build identifier among the notes of a segment; empty when there is none.
std::string identifier_in(std::string_view notes) {
  while (notes.size() > sizeof(ElfW(Nhdr))) {
    ElfW(Nhdr) head;
    notes.copy(reinterpret_cast<char*>(&head), sizeof head);
    notes.remove_prefix(sizeof head);
    const std::size_t name = aligned_note(head.n_namesz);
    if (name + aligned_note(head.n_descsz) > notes.size())
      return "";
    if (head.n_type == NT_GNU_BUILD_ID && notes.starts_with(ELF_NOTE_GNU)) {
      std::string digits;
      for (const char byte : notes.substr(name, head.n_descsz))
        digits += fmt::format("{:02x}", static_cast<unsigned char>(byte));
      return digits;
    }
    notes.remove_prefix(name + aligned_note(head.n_descsz));
  }
  return "";
}

std::string state_of_file(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  const auto changed = std::filesystem::last_write_time(file, error).time_since_epoch().count();
  return fmt::format("{} {} {}", file.string(), size, changed);
}

int add_object(dl_phdr_info* object, std::size_t, void* to) {
  std::string identifier;
  for (std::size_t i = 0; i < object->dlpi_phnum && identifier.empty(); ++i) {
    const ElfW(Phdr)& segment = object->dlpi_phdr[i];
    if (segment.p_type != PT_NOTE)
      continue;
    // The loader gives addresses as numbers. NOLINTNEXTLINE(performance-no-int-to-ptr)
    const auto* const notes = reinterpret_cast<const char*>(object->dlpi_addr + segment.p_vaddr);
    identifier = identifier_in({notes, segment.p_memsz});
  }
  *static_cast<std::string*>(to) +=
      (identifier.empty() ? state_of_file(object->dlpi_name) : identifier) + "\n";
  return 0;
}

/// What Linux says about the first processor: its name and what it can do.
std::string first_processor() {
  std::ifstream all("/proc/cpuinfo");
  std::string line, text;
  while (std::getline(all, line) && !line.empty())
    if (line.starts_with("model name") || line.starts_with("flags"))
      text += line + "\n";
  return text;
}

}  // namespace

std::string loaded_code() {
  std::string text = first_processor();
  dl_iterate_phdr(add_object, &text);
  return text;
}

}  // namespace mpm
