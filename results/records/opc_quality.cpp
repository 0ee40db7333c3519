#include "results/records/opc_quality.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

namespace mpm {
namespace {

constexpr double kLeastSeverity = 1073741824.0;  // 2^30
constexpr double kCodes = 4294967296.0;          // 2^32

/// The number in a cell, which may be hexadecimal.
std::optional<double> code_in(const RecordColumns& file, const std::string& cell) {
  if (!cell.starts_with("0x") && !cell.starts_with("0X"))
    return file.number(cell);
  std::uint32_t code = 0;
  const char* const end = cell.data() + cell.size();
  const auto [last, error] = std::from_chars(cell.data() + 2, end, code, 16);
  return error == std::errc() && last == end ? std::optional<double>(code) : std::nullopt;
}

bool begins_with_good(const std::string& cell) {
  constexpr std::string_view kGood = "good";
  return cell.size() >= kGood.size() &&
         std::equal(kGood.begin(), kGood.end(), cell.begin(),
                    [](char a, unsigned char b) { return a == std::tolower(b); });
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

bool is_good_opc(const RecordColumns& file, const std::string& cell, OpcCodes codes) {
  constexpr std::uint32_t kQuality = 0xC0;
  if (begins_with_good(cell))
    return true;
  const std::optional<double> code = code_in(file, cell);
  if (!code || *code != std::floor(*code) || *code < -kCodes / 2 || *code >= kCodes)
    return false;
  const auto bits = static_cast<std::uint32_t>(static_cast<std::int64_t>(*code));
  return codes == OpcCodes::ua ? *code >= 0.0 && *code < kLeastSeverity
                               : *code < 65536.0 && (bits & kQuality) == kQuality;
}

}  // namespace mpm
