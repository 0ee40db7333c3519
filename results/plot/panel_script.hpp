#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/non_finite.hpp"
#include "results/plot/figure.hpp"
#include "results/plot/plot_axis.hpp"

namespace mpm {

/// A point that says what it is when a mouse rests on it, and on a page leads to where more is said about it.
struct NamedPoint {
  double x, y;
  std::string name;
  std::string anchor = {};  ///< of an element of the page; empty: it leads nowhere
};

/// A value with an interval, at the place `at` of the other axis.
struct Whisker {
  double at, value, lower, upper;
  std::string name;
};

inline constexpr std::size_t kMostPoints = 4000;   ///< of one series
inline constexpr std::size_t kMostOnCurve = 1600;  ///< four to a pixel of a panel, about

/// Writes the script of one panel. What is drawn later lies on top. Points that an axis cannot show (not
/// finite, or not positive on a logarithmic axis) are left out of points and interrupt lines.
class PanelScript {
 public:
  /// `name` is unique within a figure: letters, digits and underscores, a letter first.
  PanelScript(std::string name, std::string title, Axis x, Axis y);

  /// For a curve with more than kMostOnCurve points, such as three weeks of minutes, only those are drawn
  /// that make what a screen shows: the extremes of each stretch.
  void line(const std::vector<double>& x, const std::vector<double>& y, const Pen& pen);
  /// A line that keeps the value y[k] from x[k] to x[k + 1].
  void steps(const std::vector<double>& x, const std::vector<double>& y, const Pen& pen);
  /// With more than kMostPoints points, every n-th is drawn, so that a page of a large study stays readable.
  void points(const std::vector<NamedPoint>& points, const Pen& pen);
  /// Values at x = at with upright intervals.
  void upright_whiskers(const std::vector<Whisker>& whiskers, const Pen& pen) { draw(whiskers, pen, false); }
  /// Values at y = at with intervals along x.
  void level_whiskers(const std::vector<Whisker>& whiskers, const Pen& pen) { draw(whiskers, pen, true); }
  /// A line across the panel at this y, or at this x.
  void across(double y, const Pen& pen);
  void upright(double x, const Pen& pen);
  /// A light band behind everything between two values of x.
  void upright_band(double lower, double upper);
  /// The field of a heat map around (x, y), one wide and high, with a label; `depth` from 0 (white) to 1.
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

/// A pen in gnuplot's words: for lines, for marks, and the mark without its colour.
std::string line_words(const Pen& pen);
std::string mark_words(const Pen& pen);
std::string mark_form(const Pen& pen);

}  // namespace mpm
