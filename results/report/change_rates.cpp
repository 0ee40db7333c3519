#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "results/plot/plot_text.hpp"
#include "results/report/change_sections.hpp"
#include "results/report/html_table.hpp"

namespace mpm {
namespace {

/// In percentage points, with a sign.
std::string in_points(double share) {
  return std::isnan(share) ? html_number(share) : fmt::format("{:+.1f}", 100.0 * share);
}

std::string share_cell(const Rate& rate) {
  return fmt::format("{}<br><small>{} of {}</small>", html_number(rate.value, true), rate.hits, rate.total);
}

std::string p_cell(double p) {
  return std::isnan(p) ? html_number(p) : fmt::format("{:.2g}", p);
}

/// Did a loop of it change, or is that unknown?
bool is_shown(const RateChange& change, bool paired) {
  return !paired || change.counts.first + change.counts.second > 0 || change.before.hits != change.now.hits ||
         change.before.total != change.now.total;
}

std::vector<std::string> cells_of(const RateChange& change, bool paired) {
  const ShareDifference& difference = change.difference;
  std::vector<std::string> cells{html_text(change.info->title), share_cell(change.before),
                                 share_cell(change.now)};
  if (paired)
    cells.push_back(fmt::format("{}<br><small>&minus;{}, +{}</small>", change.counts.total(),
                                change.counts.first, change.counts.second));
  cells.push_back(in_points(difference.value));
  cells.push_back(std::isnan(difference.value) ? html_number(kNaN)
                                               : fmt::format("{} to {}", in_points(difference.interval.lower),
                                                             in_points(difference.interval.upper)));
  cells.push_back(p_cell(difference.p));
  cells.push_back(p_cell(change.p_holm));
  return cells;
}

std::vector<HtmlTable::Column> rate_columns(const ChangeInput& input) {
  std::vector<HtmlTable::Column> list{{"Share of loops", HtmlTable::Align::left}, {"A"}, {"B"}};
  if (input.pairing.paired())
    list.push_back({"Counted in both"});
  list.push_back({"B &minus; A, points"});
  list.push_back({interval_title(input.now.study)});
  list.push_back({"p"});
  list.push_back({"p, corrected"});
  return list;
}

std::string caption(bool paired) {
  return paired
             ? "Rates of the methods over the experiments in common. The difference is that over the loops "
               "that "
               "the rate counts in both archives (below: those that count in A alone, and in B alone): "
               "interval "
               "of Newcombe (1998, paired, method 10), p of McNemar&rsquo;s exact test."
             : "Rates of the methods, each over all experiments of its archive. The difference is that of "
               "independent shares: interval of Newcombe (1998, method 10), p of Fisher&rsquo;s exact test.";
}

}  // namespace

ReportSection change_rates_section(const ChangeInput& input) {
  ReportSection section{"rates", "Rates of A and B", {}};
  const bool paired = input.pairing.paired();
  const auto shows = [paired](const MethodChange& method) {
    return std::any_of(method.rates.begin(), method.rates.end(),
                       [paired](const RateChange& change) { return is_shown(change, paired); });
  };
  const std::string without =
      names_of_methods(input.methods, [&](const auto& method) { return !shows(method); });
  if (names_of_methods(input.methods, shows).empty()) {
    section.leave_out("no rate of a method that both archives have differs in a single loop.");
    return section;
  }
  HtmlTable table(caption(paired) + " Corrected by Holm for the rates of the method.", rate_columns(input));
  for (const MethodChange& method : input.methods) {
    if (!shows(method))
      continue;
    table.group(html_text(method.name));
    for (const RateChange& change : method.rates)
      if (is_shown(change, paired))
        table.row(cells_of(change, paired));
  }
  section.add(table.html());
  if (paired)
    section.add(fmt::format("<p><small>Rates of which no loop changed are left out{}.</small></p>\n",
                            without.empty() ? "" : "; all those of " + html_text(without)));
  return section;
}

}  // namespace mpm
