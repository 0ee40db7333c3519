#include <cmath>
#include <map>
#include <set>

#include <catch2/catch.hpp>

#include "analysis/methods/thesis/chain_numbers.hpp"
#include "analysis/study_files/study_library.hpp"
#include "tests/analysis/made_up_record.hpp"

// A diagnosis is kept as numbers, and comes back out of them. The members are visited by structured bindings,
// which do not compile when a member is added to the structure and not here.

namespace mpm {
namespace {

template <class T, class Visit>
void each_statistic(PerStatistic<T>& part, Visit visit) {
  auto& [kts, skn, dkts, dskn] = part;
  for (T* const statistic : {&kts, &skn, &dkts, &dskn})
    visit(*statistic);
}

template <class Visit>
void each_number(MpmIndicator& indicator, Visit visit) {
  auto& [co_dkts, co_dskn, i_mpm, co_kts, co_skn, scanned, used] = indicator;
  for (double* const number : {&co_dkts, &co_dskn, &i_mpm, &co_kts, &co_skn})
    visit(*number);
  visit(scanned);
  visit(used);
}

template <class Visit>
void each_number(DistributionIndicators& indicators, Visit visit) {
  auto& [means, mpm, shape, scatter] = indicators;
  each_number(mpm, visit);
  each_statistic(means, [&](ScatterMeans& z) {
    auto& [co, ce, angle, unfolded_angle, minor_to_major, used] = z;
    for (double* const number : {&co, &ce, &angle, &unfolded_angle, &minor_to_major})
      visit(*number);
    used = 0;  // not kept
  });
  each_statistic(shape, [&](ScatterShape& z) {
    auto& [inclination, major_to_minor, regression_angle, log_r_squared] = z;
    for (double* const number : {&inclination, &major_to_minor, &regression_angle, &log_r_squared})
      visit(*number);
  });
  each_statistic(scatter, [&](CentredSums& z) {
    auto& [pairs, mean_x, mean_y, xx, xy, yy] = z;
    visit(pairs);
    for (double* const number : {&mean_x, &mean_y, &xx, &xy, &yy})
      visit(*number);
  });
}

template <class Visit>
void each_number(AcfComparison& acf, Visit visit) {
  auto& [y, y0, y0_diag, white_band, ratio, margin, speed, from_y0, from_y0_diag, diag_from_y0, share,
         origin] = acf;
  for (AcfFeatures* const features : {&y, &y0, &y0_diag}) {
    auto& [decay_lag, oscillation, values] = *features;
    auto& [verdict, decay_ratio, period] = oscillation;
    for (double* const number : {&decay_lag, &decay_ratio, &period})
      visit(*number);
    visit(verdict);
    for (double& value : values)
      visit(value);
  }
  for (double* const number : {&white_band, &ratio, &margin, &from_y0, &from_y0_diag, &diag_from_y0, &share})
    visit(*number);
  visit(speed);
  visit(origin);
}

template <class Visit>
void each_number(Diagnosis& diagnosis, Visit visit) {
  auto& [ivar, ivar_diag, impactful, predicted_cv, margin, indicator, predicted_source, alone, cvs] =
      diagnosis;
  for (Eigen::VectorXd* const indices : {&ivar, &ivar_diag})
    for (double& value : *indices)
      visit(value);
  visit(impactful);
  visit(predicted_cv);
  visit(margin);
  each_number(indicator, visit);
  visit(predicted_source);
  auto& [mpm_alone, ud_alone, dominance] = alone;
  for (double* const number : {&mpm_alone, &ud_alone, &dominance})
    visit(*number);
  for (CvDiagnosis& cv : cvs) {
    auto& [flagged, source, distribution, acf, sse] = cv;
    visit(flagged);
    visit(source);
    each_number(distribution, visit);
    each_number(acf, visit);
    visit(sse);
  }
}

/// Gives every number another value than all before it, and every verdict one of its own.
struct Filler {
  double next = 100.0;

  void operator()(double& number) { number = next++ / 8.0; }
  void operator()(int& number) { number = static_cast<int>(next++); }
  void operator()(Eigen::Index& number) { number = static_cast<Eigen::Index>(next++); }
  void operator()(bool& flag) { flag = true; }
  template <class Enum>
  void operator()(Enum& verdict) {
    verdict = static_cast<Enum>(1);
  }
};

/// All that a diagnosis holds, as numbers.
std::vector<double> content(Diagnosis diagnosis) {
  std::vector<double> list;
  each_number(diagnosis, [&](auto& member) { list.push_back(static_cast<double>(member)); });
  return list;
}

/// No two numbers alike, but for correlations that stand twice.
Diagnosis filled(const Study& study) {
  Diagnosis diagnosis;
  diagnosis.ivar.resize(study.cv_count());
  diagnosis.ivar_diag.resize(study.cv_count());
  if (study.names_scenarios())
    diagnosis.cvs.resize(static_cast<std::size_t>(study.cv_count()));
  for (CvDiagnosis& cv : diagnosis.cvs)
    for (AcfFeatures* const features : {&cv.acf.y, &cv.acf.y0, &cv.acf.y0_diag})
      features->values.resize(lag_count(study));
  Filler filler;
  each_number(diagnosis, [&filler](auto& member) { filler(member); });
  diagnosis.predicted_cv = study.cv_count() - 2;
  diagnosis.predicted_source = FaultSource::ud;
  for (std::size_t i = 0; i < diagnosis.cvs.size(); ++i) {
    CvDiagnosis& cv = diagnosis.cvs[i];
    cv.flagged = i != 1;
    cv.source = !cv.flagged ? FaultSource::none : i % 2 == 0 ? FaultSource::mpm : FaultSource::ud;
    DistributionIndicators& d = cv.distribution;
    d.mpm.co_kts = d.means.kts.co;
    d.mpm.co_skn = d.means.skn.co;
    d.mpm.co_dkts = d.means.dkts.co;
    d.mpm.co_dskn = d.means.dskn.co;
  }
  if (!diagnosis.cvs.empty())
    diagnosis.predicted_source = diagnosis.cvs[static_cast<std::size_t>(diagnosis.predicted_cv)].source;
  return diagnosis;
}

/// The chapter 6 study with short records, at random or with a named scenario.
Study short_study(bool named) {
  Study study = find_study("chapter6");
  study.simulation.samples = 20;
  if (named)
    study.scenarios.resize(1);
  return study;
}

}  // namespace

TEST_CASE("the chain's numbers: a diagnosis comes back with every member as it was") {
  for (const bool named : {false, true}) {
    INFO("named " << named);
    const Study study = short_study(named);
    const Diagnosis diagnosis = filled(study);
    const AssessmentRecord record = testing::chain_says(testing::form_of(study, "botelho"), diagnosis);
    const Diagnosis again = testing::diagnosis_of(record);
    CHECK(content(again) == content(diagnosis));
    CHECK(again.cvs.size() == diagnosis.cvs.size());
    if (named)
      CHECK(again.cvs[2].acf.y0_diag.values == diagnosis.cvs[2].acf.y0_diag.values);
  }
}

TEST_CASE("the chain's numbers: what has no value has none again") {
  const Study study = short_study(false);
  Diagnosis diagnosis;
  diagnosis.ivar = diagnosis.ivar_diag = Eigen::VectorXd::Ones(study.cv_count());
  const Diagnosis again =
      testing::diagnosis_of(testing::chain_says(testing::form_of(study, "botelho"), diagnosis));
  CHECK(std::isnan(again.alone.dominance_mpm));
  CHECK(std::isnan(again.indicator.i_mpm));
  CHECK(again.predicted_cv == 0);  // no score is larger than that of the first
  CHECK_FALSE(again.impactful);
  CHECK(again.cvs.empty());
}

TEST_CASE("the chain's numbers: without a verdict there is no diagnosis") {
  const AssessmentRecord record =
      kept(testing::form_of(short_study(true), "botelho"), Assessment::failed("a reason"));
  CHECK(std::isnan(total_simulation_error(record)));
  CHECK(std::isnan(cv_diagnosis(record, 1).sse));
  CHECK_FALSE(cv_diagnosis(record, 1).flagged);
  CHECK(record.predicted_cv == -1);
}

TEST_CASE("the chain's numbers: the simulation error of a loop is the sum of those of its CVs") {
  const Study study = short_study(true);
  const Diagnosis diagnosis = filled(study);
  double sum = 0.0;
  for (const CvDiagnosis& cv : diagnosis.cvs)
    sum += cv.sse;
  CHECK(total_simulation_error(testing::chain_says(testing::form_of(study, "botelho"), diagnosis)) == sum);
}

TEST_CASE("the chain's numbers: the rows of a study put back all that is in its diagnosis but the verdicts") {
  for (const bool named : {false, true}) {
    const Study study = short_study(named);
    const Diagnosis diagnosis = filled(study);
    Diagnosis again;
    for (const Row<Diagnosis>& row : diagnosis_rows(study))
      put_numbers(row, again, numbers_of(row, diagnosis).data());
    again.impactful = diagnosis.impactful;
    again.predicted_cv = diagnosis.predicted_cv;
    again.predicted_source = diagnosis.predicted_source;
    for (std::size_t cv = 0; cv < again.cvs.size(); ++cv) {
      again.cvs[cv].flagged = diagnosis.cvs[cv].flagged;
      again.cvs[cv].source = diagnosis.cvs[cv].source;
    }
    CHECK(content(again) == content(diagnosis));
  }
}

TEST_CASE("the chain's numbers: the list has each number of the description, once in each of its places") {
  for (const bool named : {false, true}) {
    const Study study = short_study(named);
    const auto form = testing::form_of(study, "botelho");
    std::map<std::string, std::set<std::pair<Eigen::Index, Eigen::Index>>> places;
    for (const AssessmentNumber& number : chain_numbers(filled(study))) {
      INFO(number.name);
      REQUIRE(places[number.name].insert({number.cv, number.column}).second);
    }
    // The record keeps the source that is told, of every method.
    CHECK(places.size() + 1 == form->method().numbers.size());
    for (const AssessmentNumberInfo& number : form->method().numbers) {
      INFO(number.name);
      if (number.name == told_source_info().name)
        continue;
      REQUIRE(places.contains(number.name));
      CHECK(static_cast<Eigen::Index>(places[number.name].size()) == form->find(number.name)->size());
      // A number of the loop has no CV, one of a CV no column: as those of every other method.
      const auto [cv, column] = *places[number.name].begin();
      CHECK((cv == -1) == (number.scope == NumberScope::loop));
      CHECK((column == -1) == (number.scope != NumberScope::cv_lag));
    }
  }
}

TEST_CASE("the chain's numbers: one of a named scenario has the name and the words of its indicator") {
  std::map<std::string, NumberText> infos;
  for (const AssessmentNumberInfo& info : scenario_number_infos())
    infos[info.name] = info;
  for (const auto& row : acf_rows()) {
    REQUIRE(infos.contains("cv_" + row.text.name));
    CHECK(infos["cv_" + row.text.name].words.size() == row.text.words.size());
    CHECK(infos["cv_" + row.text.name].meaning == row.text.meaning);
  }
  for (const auto& row : distribution_rows())
    CHECK(infos.contains("cv_" + row.text.name));
}

}  // namespace mpm
