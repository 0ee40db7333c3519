#include <algorithm>

#include <fmt/format.h>

#include "results/files/utf8.hpp"
#include "results/gates/gate_report.hpp"
#include "results/text/number_json.hpp"

namespace mpm {

std::string gates_badge(const GateCheck& check) {
  const auto passed = std::count_if(check.results.begin(), check.results.end(), [](const GateResult& result) {
    return result.outcome == GateOutcome::pass;
  });
  const bool all_passed = passed == std::ssize(check.results);
  return json_text({{"schemaVersion", 1},
                    {"label", "mpmbench " + plain_text(check.name)},
                    {"message", fmt::format("{} of {} gates", passed, check.results.size())},
                    {"color", !check.passed() ? "red"
                              : all_passed    ? "brightgreen"
                                              : "yellow"}});
}

}  // namespace mpm
