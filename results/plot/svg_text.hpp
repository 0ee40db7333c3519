#pragma once

#include <map>
#include <string>

namespace mpm {

/// What an SVG of gnuplot lacks and svg_element() adds.
struct SvgText {
  std::string id;                            ///< prefix of every id, so that many drawings fit into one page
  std::string description;                   ///< for people who cannot see the drawing
  std::map<std::string, std::string> names;  ///< names of points, by the hypertext that gnuplot was given
  std::map<std::string, std::string> anchors = {};  ///< where points lead in the page, by the same key
};

/// Returns the <svg> element of a drawing of gnuplot's terminal `svg`, without the XML prologue. It has a
/// role, a description, unique ids, and <title> elements in place of the hypertexts, which would need a
/// script.
std::string svg_element(const std::string& drawing, const SvgText& text);

}  // namespace mpm
