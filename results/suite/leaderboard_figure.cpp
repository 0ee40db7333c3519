#include <string>
#include <vector>

#include <fmt/format.h>

#include "results/plot/panel_script.hpp"
#include "results/plot/pens.hpp"
#include "results/plot/plot_text.hpp"
#include "results/suite/leaderboard_output.hpp"

namespace mpm {
namespace {

const Pen kLimit{colour::kGrey, Dash::dotted, Mark::none, 1.2};

/// What a method flags of the faults with an impact against what it flags of the healthy loops; nothing
/// where one of them was not counted.
std::vector<NamedPoint> family_point(const std::string& method, const PooledScores& scores) {
  const Rate* const detected = scores.of("detected_impact");
  const Rate* const alarms = scores.of("false_alarm_healthy");
  if (detected == nullptr || alarms == nullptr || detected->total == 0 || alarms->total == 0)
    return {};
  return {{100 * alarms->value, 100 * detected->value,
           fmt::format("{}: {:.1f} % of {} faults with an impact flagged, and {:.1f} % of {} healthy loops",
                       method, 100 * detected->value, detected->total, 100 * alarms->value, alarms->total)}};
}

Panel family_panel(const Leaderboard& board, std::size_t family) {
  const std::vector<double> ticks{0, 20, 40, 60, 80, 100};
  PanelScript panel(
      fmt::format("family_{}", family), as_label(board.families[family].name),
      {.label = "healthy loops flagged (%)", .lower = -3, .upper = 103, .ticks = ticks},
      {.label = "faults with an impact flagged (%)", .lower = -3, .upper = 103, .ticks = ticks});
  panel.across(100 * kPassingShare, kLimit);
  panel.upright(100 * kPassingFalseAlarms, kLimit);
  for (std::size_t method = 0; method < board.methods.size(); ++method) {
    Pen pen = method_pen(method);
    pen.size *= 1.3;
    panel.points(family_point(label_of(board.methods[method]), board.by_family[method][family]), pen);
  }
  return panel.finish(fmt::format("Faults that are detected against false alarms in the family {}, a mark a "
                                  "method.",
                                  board.families[family].name),
                      300);
}

}  // namespace

Figure leaderboard_figure(const Leaderboard& board) {
  Figure figure;
  figure.name = "leaderboard";
  figure.caption = fmt::format(
      "Each family with the methods that answer on it: the upper left corner is where all faults with an "
      "impact "
      "are flagged and no healthy loop. Detection is passed to the upper left of the dotted lines ({:g} and "
      "{:g} %).",
      100 * kPassingShare, 100 * kPassingFalseAlarms);
  figure.columns = 3;
  for (std::size_t method = 0; method < board.methods.size(); ++method) {
    Pen pen = method_pen(method);
    pen.dash = Dash::none;
    figure.legend.push_back({as_label(label_of(board.methods[method])), pen});
  }
  for (std::size_t family = 0; family < board.families.size(); ++family)
    figure.panels.push_back(family_panel(board, family));
  return figure;
}

}  // namespace mpm
