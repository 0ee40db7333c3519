#include "results/plot/pens.hpp"

#include <array>
#include <string_view>

namespace mpm {
namespace {

constexpr std::array<std::string_view, 7> kColours{colour::kBlue, colour::kOrange,     colour::kGreen,
                                                   colour::kSky,  colour::kVermillion, colour::kPurple,
                                                   colour::kBlack};
constexpr std::array<Dash, 3> kDashes{Dash::solid, Dash::dashed, Dash::dotted};

/// Of the methods, in their order; neighbours differ in dash as well. Each further round has the colours
/// moved by one, so that no two methods share mark and colour.
constexpr std::array<Pen, 7> kMethodPens{{
    {colour::kBlue, Dash::solid, Mark::dot, 2.0, 0.8},
    {colour::kVermillion, Dash::dashed, Mark::square, 2.0, 0.8},
    {colour::kGreen, Dash::solid, Mark::triangle, 2.0, 0.9},
    {colour::kPurple, Dash::dashed, Mark::diamond, 2.0, 1.0},
    {colour::kOrange, Dash::solid, Mark::circle, 2.0, 0.8},
    {colour::kSky, Dash::dotted, Mark::hollow_diamond, 2.0, 1.0},
    {colour::kBlack, Dash::dashed, Mark::circle, 1.5, 0.8},
}};
}  // namespace

Pen method_pen(std::size_t method) {
  const std::size_t round = method / kMethodPens.size();
  Pen pen = kMethodPens[method % kMethodPens.size()];
  pen.colour = kMethodPens[(method + round) % kMethodPens.size()].colour;
  return pen;
}

Pen cv_pen(Eigen::Index cv, bool thick) {
  const auto i = static_cast<std::size_t>(cv);
  return {kColours[i % kColours.size()], kDashes[(i / kColours.size()) % kDashes.size()], Mark::none,
          thick ? 3.0 : 1.5};
}

}  // namespace mpm
