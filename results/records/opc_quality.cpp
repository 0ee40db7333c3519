#include "results/records/opc_quality.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

#include "results/files/utf8.hpp"

namespace mpm {
namespace {

constexpr std::uint32_t kLeastSeverity = 1U << 30U;
constexpr std::uint32_t kDaCodes = 1U << 16U, kDaQuality = 0xC0;
constexpr double kCodes = 4294967296.0;  // 2^32

/// Returns the number in a cell, which may be hexadecimal.
std::optional<double> code_in(const RecordColumns& file, const std::string& cell) {
  if (!cell.starts_with("0x") && !cell.starts_with("0X"))
    return file.number(cell);
  std::uint32_t code = 0;
  const char* const end = cell.data() + cell.size();
  const auto [last, error] = std::from_chars(cell.data() + 2, end, code, 16);
  return error == std::errc() && last == end ? std::optional<double>(code) : std::nullopt;
}

/// Returns the code as 32 bits; none if it is no such code.
std::optional<std::uint32_t> bits_in(const RecordColumns& file, const std::string& cell) {
  const std::optional<double> code = code_in(file, cell);
  if (!code || *code != std::floor(*code) || *code < -kCodes / 2 || *code >= kCodes)
    return std::nullopt;
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(*code));
}

bool begins_with(const std::string& cell, std::string_view word) {
  return in_lower_case(cell.substr(0, word.size())) == word;
}

}  // namespace

OpcCodes opc_codes(const RecordColumns& file, std::size_t column) {
  const std::vector<std::string>& cells = file.columns[column];
  const bool ua = std::any_of(cells.begin(), cells.end(), [&](const std::string& cell) {
    const std::optional<double> code = code_in(file, cell);
    return code && (*code < 0.0 || *code >= kLeastSeverity);
  });
  return ua ? OpcCodes::ua : OpcCodes::da;
}

bool is_opc_code(const RecordColumns& file, const std::string& cell) {
  return code_in(file, cell).has_value();
}

bool is_good_opc(const RecordColumns& file, const std::string& cell, OpcCodes codes) {
  if (begins_with(cell, "good"))
    return true;
  const std::optional<std::uint32_t> bits = bits_in(file, cell);
  return bits && (codes == OpcCodes::ua ? *bits < kLeastSeverity
                                        : *bits < kDaCodes && (*bits & kDaQuality) == kDaQuality);
}

bool is_opc_quality(const RecordColumns& file, const std::string& cell, OpcCodes codes) {
  if (!code_in(file, cell))
    return true;
  const std::optional<std::uint32_t> bits = bits_in(file, cell);
  if (!bits)
    return false;
  if (codes == OpcCodes::ua)
    return *bits == 0 || *bits >= kLeastSeverity;
  constexpr std::array<std::uint32_t, 15> kOfDa{0, 4, 8, 12, 16, 20, 24, 28, 64, 68, 80, 84, 88, 192, 216};
  constexpr std::uint32_t kWithoutLimits = 0xFC;
  return *bits < kDaCodes && std::find(kOfDa.begin(), kOfDa.end(), *bits & kWithoutLimits) != kOfDa.end();
}

}  // namespace mpm
