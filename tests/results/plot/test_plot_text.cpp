#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "results/plot/figure_format.hpp"
#include "results/plot/plot_text.hpp"
#include "results/text/experiment_heading.hpp"
#include "results/text/experiment_text.hpp"
#include "tests/analysis/made_up_record.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using Catch::Contains;

TEST_CASE("plot text: a foreign text shows its characters in every form, whatever they are") {
  const std::string foreign = "a_b^{c} 'd' \"e\" <f> & `g` @h \\i ~j";
  const std::string label = as_label(foreign);
  CHECK(plain_label(label) == foreign);
  CHECK(html_label(label) == html_text(foreign));
  CHECK(html_text("<b a=\"'&") == "&lt;b a=&quot;&#39;&amp;");
  // For gnuplot: in single quotes, with U+2019 for ', each sign of markup behind a backslash.
  CHECK(gnuplot_label(label) ==
        "'a\\_b\\^\\{c\\} \xE2\x80\x99"
        "d\xE2\x80\x99 \"e\" <f> \\& `g` \\@h \\\\i \\~j'");
}

TEST_CASE("plot text: subscripts of our own labels") {
  CHECK(gnuplot_label("I_{MPM} (-)") == "'I_{MPM} (-)'");
  CHECK(html_label("I_{MPM} < 0.1") == "I<sub>MPM</sub> &lt; 0.1");
  CHECK(plain_label("Ivar_{basis} = Ivar") == "Ivar_basis = Ivar");
  CHECK(html_label("I_{MPM") == "I<sub>MPM</sub>");  // closed in any case
}

TEST_CASE("plot text: control characters and broken UTF-8 do not get through") {
  CHECK(shown_text("a\nb\tc\x7f") == "a b c ");
  CHECK(gnuplot_label(as_label("a\nsystem('x')")) == "'a system(\xE2\x80\x99x\xE2\x80\x99)'");
  CHECK(shown_text("\xFF") == "\xEF\xBF\xBD");
  CHECK(html_text("R\xC2\xB2") == "R\xC2\xB2");
}

TEST_CASE("plot text: the text of a scenario names all its faults, and each CV in its verdict") {
  const Campaign campaign = testing::scenario_campaign();
  const Study& study = campaign.study;
  CHECK(experiment_title(study, campaign.records[0].draw) == "healthy (healthy): nothing");
  CHECK(fault_text(study, campaign.records[2].draw) ==
        "disturbance on level: gain 0.5, time constant 6 s, white 1; "
        "disturbance on level: white 2 held for 3 samples; "
        "disturbance on heat: sine of amplitude 0.2, period 30 s; "
        "disturbance on heat: (0.3 s + 2) / (100 s^2 + 30 s), ramp of 0.01 a s from 7 s; "
        "disturbance on heat: gain 1, time constant 8 s, 2 steps");
  const std::vector<std::string> heading = experiment_heading(study, campaign.records[2]);
  REQUIRE(heading.size() == 6);  // no two of the five faults fit on a line
  CHECK(heading[0] == "signals (UD): disturbance on level: gain 0.5, time constant 6 s, white 1;");
  CHECK(std::all_of(heading.begin(), heading.end(), [](const auto& line) { return line.size() <= 100; }));
  ExperimentRecord record = campaign.records[2];
  Diagnosis chain = testing::diagnosis_of(record.chain());
  for (CvDiagnosis& cv : chain.cvs)
    cv = {true, FaultSource::mpm, {}, {}, 0.0};
  testing::set_chain(study, record, chain);
  CHECK(verdict_text(study, record) == "flagged level (MPM), heat (MPM); false alarm level; source of heat");
}

TEST_CASE("plot text: the text of an experiment names its fault and its verdict") {
  const Campaign campaign = testing::made_up_campaign();
  const Study& study = campaign.study;
  ExperimentRecord record;
  for (const auto& form : forms_of(campaign))
    record.assessments.push_back(testing::unasked(form));
  record.draw.index = 12;
  record.draw.kind = ExperimentKind::mpm_ud;
  record.draw.mismatches = {{0, 1, MismatchParameter::dead_time, -1.5}};
  record.draw.disturbances = {{0, 2.0, 40.0}};
  record.status = ExperimentStatus::infeasible;
  CHECK(experiment_line(study, record) ==
        "experiment 12 (MPM+UD): dead time of level/cold -1.5 s; disturbance on level: gain 2, time constant "
        "40 "
        "s; infeasible");
  record.draw.disturbances.clear();
  record.draw.mismatches.front().parameter = MismatchParameter::gain;
  record.status = ExperimentStatus::ok;
  CHECK(verdict_text(study, record) == "not assessed by the chain");
  Diagnosis chain;
  chain.ivar = chain.ivar_diag = Eigen::Vector2d::Ones();
  chain.predicted_cv = 1;
  chain.predicted_source = FaultSource::ud;
  chain.indicator.i_mpm = 0.0625;
  testing::set_chain(study, record, chain);
  CHECK(verdict_text(study, record) == "no impact, located heat, I_MPM 0.062: UD");
  chain.indicator.i_mpm = NAN;
  chain.predicted_source = FaultSource::none;
  testing::set_chain(study, record, chain);
  CHECK(verdict_text(study, record) == "no impact, located heat, no I_MPM");
  CHECK_THAT(experiment_title(study, record.draw), Contains("gain of level/cold x -1.5"));
  CHECK(fault_text(study, {}) == "nothing");
}

TEST_CASE("plot text: formats of figures, by name and by file; others are refused with the known ones") {
  CHECK(figure_format("pdf") == FigureFormat::pdf);
  CHECK(figure_format_of("a/b.c/figure.svg") == FigureFormat::svg);
  CHECK_THROWS_WITH(figure_format("jpg"), Contains("'jpg'") && Contains("svg, pdf, png"));
  CHECK_THROWS_WITH(figure_format_of("figure.jpg"), Contains("'figure.jpg'") && Contains(".svg, .pdf, .png"));
  CHECK_THROWS_AS(figure_format_of("svg"), InputError);
}

}  // namespace
