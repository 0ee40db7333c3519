#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace mpm {

/// The colours of Okabe and Ito (2008), which people with any colour vision can tell apart, and two greys for
/// the background.
namespace colour {
inline constexpr std::string_view kBlack = "#000000";
inline constexpr std::string_view kOrange = "#E69F00";
inline constexpr std::string_view kSky = "#56B4E9";
inline constexpr std::string_view kGreen = "#009E73";
inline constexpr std::string_view kBlue = "#0072B2";
inline constexpr std::string_view kVermillion = "#D55E00";
inline constexpr std::string_view kPurple = "#CC79A7";
inline constexpr std::string_view kGrey = "#767676";
inline constexpr std::string_view kLightGrey = "#A3A9AF";
}  // namespace colour

enum class Dash { none, solid, dashed, dotted };  ///< none: no line
enum class Mark {
  none,
  dot,
  circle,
  triangle,
  square,
  diamond,
  hollow_diamond
};  ///< a circle is hollow as well

/// How a series is drawn. Series differ in mark or dash as well as in colour.
struct Pen {
  std::string_view colour = colour::kBlack;
  Dash dash = Dash::solid;
  Mark mark = Mark::none;
  double width = 1.5;  ///< width of the line, in pixels
  double size = 0.5;   ///< size of the mark, in gnuplot's unit
};

/// What a pen stands for.
struct LegendEntry {
  std::string label;
  Pen pen;
};

inline constexpr double kPanelWidth = 420;  ///< pixels; text is 12 pixels high

/// One plot: made by PanelScript, drawn by draw_panels() and draw_figure().
struct Panel {
  std::string title;                                ///< label
  std::string description;                          ///< for people who cannot see the panel
  double height = 300, width = kPanelWidth;         ///< pixels; in a grid, all panels are kPanelWidth wide
  std::string data;                                 ///< data blocks of gnuplot
  std::string commands;                             ///< the plot itself, as gnuplot commands
  std::map<std::string, std::string> names;         ///< names of points, by their hypertext in `data`
  std::map<std::string, std::string> anchors = {};  ///< where points of a page lead, by the same key
};

/// Panels that belong together. A page arranges them beside or below each other, as the screen allows; a file
/// of its own has them in a grid.
struct Figure {
  std::string name;                  ///< of the file and the anchor: lower case, digits, hyphens
  std::string caption;               ///< label; shown on a page, not in a file of its own
  std::vector<std::string> heading;  ///< labels: lines above the grid, in a file of its own
  std::vector<LegendEntry> legend;
  std::vector<Panel> panels;
  std::size_t columns = 2;  ///< of the grid
};

}  // namespace mpm
