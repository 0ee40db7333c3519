#pragma once

#include <map>
#include <string>

namespace mpm {

/// Adds what an SVG of gnuplot lacks.
struct SvgText {
  std::string id;                            ///< before every id, so that many drawings fit into one page
  std::string description;                   ///< for people who do not see it
  std::map<std::string, std::string> names;  ///< of points, by the hypertext that gnuplot was given
  std::map<std::string, std::string> anchors = {};  ///< in the same page, of points that lead somewhere
};

/// The <svg> element of a drawing of gnuplot's terminal `svg`, without prologue: with a role and a
/// description, unique ids, and <title> elements instead of the hypertexts, which would need a script.
std::string svg_element(const std::string& drawing, const SvgText& text);

}  // namespace mpm
