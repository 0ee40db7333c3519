#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/non_finite.hpp"
#include "results/plot/figure.hpp"
#include "results/plot/plot_axis.hpp"

namespace mpm {

/// A point that shows its name when the mouse rests on it. On a page it can link to details.
struct NamedPoint {
  double x, y;
  std::string name;
  std::string anchor = {};  ///< of an element of the page; empty: no link
};

/// A value with an interval, at position `at` on the other axis.
struct Whisker {
  double at, value, lower, upper;
  std::string name;
};

inline constexpr std::size_t kMostPoints = 4000;   ///< of one series of points
inline constexpr std::size_t kMostOnCurve = 1600;  ///< of one curve: about four to a pixel

/// Writes the script of one panel. Later drawings lie on top of earlier ones. Points that an axis cannot show
/// (not finite, or not positive on a logarithmic axis) are left out of points and interrupt lines.
class PanelScript {
 public:
  /// `name` must be unique within a figure: letters, digits and underscores, a letter first.
  PanelScript(std::string name, std::string title, Axis x, Axis y);

  /// Draws a curve. If it has more than kMostOnCurve points, such as three weeks of minutes, only those are
  /// drawn that a screen can show: the extremes of each stretch.
  void line(const std::vector<double>& x, const std::vector<double>& y, const Pen& pen);
  /// Draws a line that keeps the value y[k] from x[k] to x[k + 1].
  void steps(const std::vector<double>& x, const std::vector<double>& y, const Pen& pen);
  /// Draws points. Of more than kMostPoints points only every n-th is drawn, so that a page of a large study
  /// stays readable.
  void points(const std::vector<NamedPoint>& points, const Pen& pen);
  /// Draws values at x = at with vertical intervals.
  void upright_whiskers(const std::vector<Whisker>& whiskers, const Pen& pen) { draw(whiskers, pen, false); }
  /// Draws values at y = at with horizontal intervals.
  void level_whiskers(const std::vector<Whisker>& whiskers, const Pen& pen) { draw(whiskers, pen, true); }
  /// Draws a line across the whole panel, at this y or at this x.
  void across(double y, const Pen& pen);
  void upright(double x, const Pen& pen);
  /// Draws a light band between two values of x, behind everything else.
  void upright_band(double lower, double upper);
  /// Draws one field of a heat map, centred at (x, y), of width and height 1, with a label. `depth` is from 0
  /// (white) to 1.
  void field(double x, double y, std::string_view colour, double depth, const std::string& label);

  Panel finish(std::string description, double height = 300, double width = kPanelWidth);

 private:
  struct Extent {
    double least = kInfinity;
    double largest = -kInfinity;
  };

  void see(const Axis& axis, Extent& extent, double value) const;
  bool shows(double x, double y) const;
  std::vector<std::size_t> shown_places(const std::vector<double>& x, const std::vector<double>& y) const;
  void draw(const std::vector<Whisker>& whiskers, const Pen& pen, bool level);
  std::string block(const std::string& rows);
  void curve(const std::vector<double>& x, const std::vector<double>& y, const Pen& pen, const char* style);
  std::string name_point(const std::string& name, const std::string& anchor = {});
  void draw_marks(const std::string& rows, const Pen& pen);
  void plot(const std::string& item);

  std::string name_;
  std::string title_;
  Axis x_, y_;
  Extent x_extent_, y_extent_;
  int blocks_ = 0;
  std::string settings_;
  std::vector<std::string> items_;
  Panel panel_;
};

/// Pens in gnuplot's words: as a line, as a mark, and as a mark without its colour.
std::string line_words(const Pen& pen);
std::string mark_words(const Pen& pen);
std::string mark_form(const Pen& pen);

}  // namespace mpm
