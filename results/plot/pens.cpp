#include "results/plot/pens.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace mpm {
namespace {

constexpr std::array<std::string_view, 7> kColours{colour::kBlue, colour::kOrange,     colour::kGreen,
                                                   colour::kSky,  colour::kVermillion, colour::kPurple,
                                                   colour::kBlack};
constexpr std::array<Dash, 3> kDashes{Dash::solid, Dash::dashed, Dash::dotted};

/// The pens of the first methods, in their order. Neighbours also differ in dash.
constexpr std::array<Pen, 7> kMethodPens{{
    {colour::kBlue, Dash::solid, Mark::dot, 2.0, 0.8},
    {colour::kVermillion, Dash::dashed, Mark::square, 2.0, 0.8},
    {colour::kGreen, Dash::solid, Mark::triangle, 2.0, 0.9},
    {colour::kPurple, Dash::dashed, Mark::diamond, 2.0, 1.0},
    {colour::kOrange, Dash::solid, Mark::circle, 2.0, 0.8},
    {colour::kSky, Dash::dotted, Mark::hollow_diamond, 2.0, 1.0},
    {colour::kBlack, Dash::dashed, Mark::circle, 1.5, 0.8},
}};

/// The colours of the methods after these. They were chosen one by one, each as far as possible from all
/// before it and from white (differences in CIELAB, also as people with deuteranopia or protanopia see them).
constexpr std::array<std::string_view, 14> kMoreColours{"#001E96", "#692D0F", "#B44BFF", "#C3C378", "#69005A",
                                                        "#E1004B", "#96D2A5", "#870F3C", "#005AC3", "#785A78",
                                                        "#A587FF", "#00C837", "#0000FF", "#8C8C3C"};

}  // namespace

Pen method_pen(std::size_t method) {
  const std::size_t place = method % kMethodPens.size(), round = method / kMethodPens.size();
  Pen pen = kMethodPens[place];
  if (round == 0)
    return pen;
  pen.colour = kMoreColours[(method - kMethodPens.size()) % kMoreColours.size()];
  const auto dash = std::find(kDashes.begin(), kDashes.end(), pen.dash) - kDashes.begin();
  pen.dash = kDashes[(static_cast<std::size_t>(dash) + round) % kDashes.size()];
  return pen;
}

Pen cv_pen(Eigen::Index cv, bool thick) {
  const auto i = static_cast<std::size_t>(cv);
  return {kColours[i % kColours.size()], kDashes[(i / kColours.size()) % kDashes.size()], Mark::none,
          thick ? 3.0 : 1.5};
}

}  // namespace mpm
