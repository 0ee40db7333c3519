#include "results/plot/pens.hpp"

#include <array>
#include <string_view>

namespace mpm {
namespace {

constexpr std::array<std::string_view, 7> kColours{colour::kBlue, colour::kOrange,     colour::kGreen,
                                                   colour::kSky,  colour::kVermillion, colour::kPurple,
                                                   colour::kBlack};
constexpr std::array<Dash, 3> kDashes{Dash::solid, Dash::dashed, Dash::dotted};

}  // namespace

Pen cv_pen(Eigen::Index cv, bool thick) {
  const auto i = static_cast<std::size_t>(cv);
  return {kColours[i % kColours.size()], kDashes[(i / kColours.size()) % kDashes.size()], Mark::none,
          thick ? 3.0 : 1.5};
}

}  // namespace mpm
