#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/study_files/study_library.hpp"
#include "base/non_finite.hpp"
#include "results/plot/figure_drawing.hpp"
#include "results/plot/gnuplot.hpp"
#include "results/plot/panel_script.hpp"
#include "results/plot/plot_text.hpp"
#include "results/plot/svg_text.hpp"
#include "results/plot/trajectory_figure.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;
using Catch::Contains;

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1))
    ++found;
  return found;
}

Panel small_panel(const std::string& name, const std::string& title) {
  PanelScript panel(name, title, {.label = "time (min)"}, {.label = "I_{MPM} (-)"});
  panel.line({0, 1, NAN, 2, 3}, {1, 2, 3, 4, 5}, {});
  panel.points({{0, 1, "first <point>"}, {1, NAN, "nowhere"}, {2, 2, "second 'point'"}},
               {colour::kBlue, Dash::none, Mark::dot});
  panel.upright_whiskers({{1, 2, 1, 3, "a mean"}}, {colour::kGreen, Dash::solid, Mark::square});
  return panel.finish("A small panel & its description.");
}

std::vector<std::string> drawn(const std::vector<Panel>& panels) {
  Figure figure;
  figure.name = "fig";
  figure.panels = panels;
  return draw_panels(figure);
}

std::string draw_panel(const Panel& panel) {
  return drawn({panel}).at(0);
}

TEST_CASE("a long curve has the points that a screen shows: ends, extremes and gaps") {
  const auto rows_of = [](const std::vector<double>& y) {
    std::vector<double> x(y.size());
    std::iota(x.begin(), x.end(), 0.0);
    PanelScript panel("long", "", {.label = "k"}, {.label = "y"});
    panel.line(x, y, Pen{});
    return panel.finish("a curve").data;
  };
  std::vector<double> y(30'000, 0.0);
  for (std::size_t k = 0; k < y.size(); ++k)
    y[k] = k % 2 == 0 ? 1.0 : -1.0;
  y[12'345] = 7.0;
  y[23'456] = -8.0;
  std::fill_n(y.begin() + 20'000, 10, kNaN);
  const std::string rows = rows_of(y);
  CHECK(10 * std::count(rows.begin(), rows.end(), '\n') < 11 * std::int64_t{kMostOnCurve});
  CHECK_THAT(rows, Contains("\n12345 7\n") && Contains("\n23456 -8\n") && Contains("\n29999 -1\n"));
  CHECK_THAT(rows, Contains("\n\n"));  // the gap
  const std::string all = rows_of(std::vector<double>(kMostOnCurve, 1.0));
  CHECK(std::count(all.begin(), all.end(), '\n') == kMostOnCurve + 2);
}

TEST_CASE("figures: a loop is drawn to its own scale, with the limits that are near") {
  const Study study = find_study("wood-berry");  // xD: soft [0, 1], hard [-4, 4]
  Trajectory loop;
  loop.samples_done = 3;
  loop.y = (Eigen::MatrixXd(2, 3) << -0.1, 0.0, 0.1, -3.0, 0.0, 1.0).finished();
  loop.u = loop.u_target = Eigen::MatrixXd::Zero(2, 3);
  loop.d = Eigen::MatrixXd::Zero(1, 3);
  const Figure figure = trajectory_figure(study, loop, {loop.y, loop.y, loop.y}, "loop");
  const auto limits = [&](std::size_t panel) { return count(figure.panels.at(panel).commands, "set arrow"); };
  CHECK(limits(0) == 1);  // xD from -0.1 to 0.1: its lower soft limit 0; the upper one is far off
  CHECK(limits(1) == 4);  // xB from -3 to 1: all four
  CHECK(limits(2) == 2);  // R stands still: nothing tells what is near
}

TEST_CASE("figures: every point names itself without a script, and what cannot be shown is left out") {
  const std::string svg = draw_panel(small_panel("p", "title"));
  CHECK(svg.rfind("<svg ", 0) == 0);
  CHECK_THAT(svg, Contains("<title>first &lt;point&gt;</title>") &&
                      Contains("<title>second 'point'</title>") && Contains("<title>a mean</title>"));
  CHECK_THAT(svg, !Contains("nowhere") && !Contains("onmouse") && !Contains("<script"));
  CHECK(count(svg, "<title>") == 3);
  CHECK_THAT(svg, Contains("role=\"img\" aria-label=\"A small panel &amp; its description.\""));
}

TEST_CASE("figures: ids begin with the name of the drawing, and references follow") {
  const std::string svg = draw_panel(small_panel("p", "title"));
  CHECK(count(svg, " id=\"") == count(svg, " id=\"fig-0-"));
  CHECK(count(svg, "href=\"#") == count(svg, "href=\"#fig-0-"));
  CHECK(count(svg, "href=\"#") > 4);
}

TEST_CASE("figures: a drawing keeps its content, without what says nothing") {
  const std::string drawing =
      "<?xml version=\"1.0\"?>\n<svg width=\"9\" viewBox=\"0 0 30 20\" "
      "onload=\"run()\">\n<desc>waste</desc>\n"
      "<g id=\"plot\"><title>waste</title>\n<g fill=\"none\">\n</g>\n"
      "<text><tspan>a </tspan><tspan> </tspan><tspan>&lt;b&gt;</tspan></text></g>\n</svg>\n";
  CHECK(svg_element(drawing, {"f", "said \"so\"", {}}) ==
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"30\" "
        "height=\"20\" viewBox=\"0 0 30 20\" role=\"img\" aria-label=\"said &quot;so&quot;\">"
        "<g id=\"f-plot\"><text><tspan>a </tspan><tspan> </tspan><tspan>&lt;b&gt;</tspan></text></g></svg>");
}

TEST_CASE("figures: the same panel gives the same bytes") {
  CHECK(draw_panel(small_panel("p", "t")) == draw_panel(small_panel("p", "t")));
}

TEST_CASE("figures: a panel is drawn in the same way whichever stands before it") {
  PanelScript other("a", "other", {.label = "", .words = {"one", "two"}}, {.label = "", .logarithmic = true});
  other.points({{0, 10, "other point"}}, {colour::kOrange, Dash::none, Mark::square});
  const Panel panel = small_panel("p", "title");
  const std::vector<std::string> svgs = drawn({other.finish("other"), panel, panel});
  REQUIRE(svgs.size() == 3);
  CHECK_THAT(svgs[0], Contains("other point") && Contains("fig-0-") && !Contains("fig-1-"));
  const auto as_first = [](std::string svg, const std::string& id) {
    for (std::size_t at = svg.find(id); at != std::string::npos; at = svg.find(id, at))
      svg.replace(at, id.size(), "fig-0-");
    return svg;
  };
  CHECK(as_first(svgs[1], "fig-1-") == draw_panel(panel));
  CHECK(as_first(svgs[2], "fig-2-") == draw_panel(panel));
  CHECK(drawn({}).empty());
}

TEST_CASE("figures: a foreign title runs no command") {
  const TemporaryFolder folder;
  const std::string trap = (folder / "trap").string();
  for (const std::string& title :
       {"`touch " + trap + "`", "' . system('touch " + trap + "') . '",
        "$(touch " + trap + ")\nsystem 'touch " + trap + "'", std::string("@x {/*9 %d")})
    CHECK_NOTHROW(draw_panel(small_panel("p", as_label(title))));
  CHECK_FALSE(std::filesystem::exists(trap));
}

TEST_CASE("figures: a figure with heading, legend and panels in each format") {
  Figure figure;
  figure.name = "sample";
  figure.heading = {"heading", "second line"};
  figure.legend = {{"line, y_{0}", {}},
                   {"mark", {colour::kBlue, Dash::none, Mark::triangle}},
                   {"both", {colour::kBlue, Dash::solid, Mark::circle}}};
  for (const char* name : {"a", "b", "c"})
    figure.panels.push_back(small_panel(name, name));
  const std::string svg = draw_figure(figure, FigureFormat::svg);
  CHECK_THAT(svg, Contains("<?xml") && Contains("second line") && Contains("first &lt;point&gt;"));
  CHECK(count(svg, "<title>") == 9);
  CHECK(draw_figure(figure, FigureFormat::svg) == svg);
  CHECK(draw_figure(figure, FigureFormat::pdf).rfind("%PDF-", 0) == 0);
  CHECK(draw_figure(figure, FigureFormat::png).rfind("\x89PNG", 0) == 0);
}

TEST_CASE("figures: a panel without data, with one point, and on logarithmic axes can be drawn") {
  CHECK_THAT(draw_panel(PanelScript("a", "", {}, {}).finish("nothing")), Contains("</svg>"));
  PanelScript one("a", "", {}, {});
  one.points({{5, 5, "only"}}, {colour::kBlue, Dash::none, Mark::dot});
  CHECK_THAT(draw_panel(one.finish("one")), Contains("<title>only</title>"));
  PanelScript logarithmic("a", "", {.label = "", .logarithmic = true}, {.label = "", .logarithmic = true});
  logarithmic.points({{1e-3, 1e5, "shown"}, {0, 1, "zero"}, {-1, 1, "negative"}},
                     {colour::kBlue, Dash::none, Mark::dot});
  const std::string svg = draw_panel(logarithmic.finish("log"));
  CHECK_THAT(svg, Contains("<title>shown</title>") && !Contains("zero") && !Contains("negative"));
}

TEST_CASE("figures: whatever numbers a panel gets, it can be drawn") {
  const std::vector<double> odd{0.0,   1.0,    1.0 + 1e-9, 1.0 - 1e-12, 1e9,      1e9 + 1e-3, -1e99, 1e99,
                                1e-99, 1e-308, 1e308,      NAN,         INFINITY, -INFINITY,  -0.0,  -5.0};
  std::vector<Panel> panels;
  for (const bool logarithmic : {false, true})
    for (const double one : odd)
      for (const double other : odd) {
        PanelScript panel("p", "", {.label = "x", .logarithmic = logarithmic, .lower = one, .upper = other},
                          {.label = "y", .logarithmic = logarithmic, .ticks = {one, other}});
        panel.line({one, other}, {other, one}, {});
        panel.points({{one, other, "a point"}}, {colour::kBlue, Dash::none, Mark::dot});
        panel.upright_whiskers({{one, other, one, other, "a mean"}},
                               {colour::kGreen, Dash::solid, Mark::dot});
        panel.across(one, {});
        panel.upright(other, {});
        panel.upright_band(one, other);
        panel.field(0.0, 0.0, colour::kSky, other, "field");
        panels.push_back(panel.finish("odd"));
      }
  CHECK(drawn(panels).size() == panels.size());
}

TEST_CASE("figures: a heat map with foreign names on its axes") {
  const std::string awkward = as_label("100 %d `x` 'y' {_^");
  PanelScript map("a", "", {.label = "", .words = {"one", awkward}},
                  {.label = "", .words = {awkward, "two"}});
  map.field(0, 0, colour::kSky, 0.8, "12");
  map.field(1, 1, colour::kOrange, 0.2, "34");
  const std::string svg = draw_panel(map.finish("map"));
  CHECK(count(svg, "100 %d `x` \xE2\x80\x99y\xE2\x80\x99 {_^") == 2);
  CHECK_THAT(svg, Contains(">12</tspan>") && Contains(">34</tspan>"));
}

TEST_CASE("figures: of very many points every n-th is drawn") {
  std::vector<NamedPoint> points;
  for (int i = 0; i < 3 * static_cast<int>(kMostPoints); ++i)
    points.push_back({static_cast<double>(i), 1.0, "p"});
  PanelScript panel("a", "", {}, {});
  panel.points(points, {colour::kBlue, Dash::none, Mark::dot});
  CHECK(panel.finish("many").names.size() == kMostPoints);
}

TEST_CASE("gnuplot: a missing program, a wrong script and a silent one are errors that say so") {
  CHECK_THROWS_WITH(run_gnuplot("", "no-such-gnuplot"),
                    Contains("cannot start no-such-gnuplot") && Contains("install gnuplot"));
  CHECK_THROWS_WITH(run_gnuplot("set terminal svg\nplot nonsense +\n"), Contains("could not draw"));
  CHECK_THROWS_WITH(run_gnuplot("x = 1\n"), Contains("could not draw"));
  ::setenv("GNUTERM", "no-such-terminal", 1);
  CHECK_THAT(run_gnuplot("set terminal svg\nplot 1\n"), Contains("<svg"));
  ::unsetenv("GNUTERM");
  const TemporaryFolder folder;
  make_file(folder / "hangs", "#!/bin/sh\nexec sleep 1000\n");
  std::filesystem::permissions(folder / "hangs", std::filesystem::perms::owner_all);
  CHECK_THROWS_WITH(run_gnuplot("", folder / "hangs", std::chrono::milliseconds(50)),
                    Contains("did not draw a figure within 0.05 s"));
  CHECK_THROWS_AS(svg_element("no drawing", {}), GnuplotError);
  CHECK_THROWS_AS(svg_element("<svg viewBox='0 0 1 1'><g>", {}), GnuplotError);
  CHECK_THROWS_AS(svg_element("<g viewBox='0 0 1 1'/>", {}), GnuplotError);
}

}  // namespace
