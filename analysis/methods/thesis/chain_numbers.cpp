#include "analysis/methods/thesis/chain_numbers.hpp"

#include <cmath>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>

namespace mpm {
namespace {

/// A number, and how it is taken out of a diagnosis and put back: at a CV and at a lag, 0 where it has none.
struct ChainNumber {
  AssessmentNumberInfo info;
  std::function<double(const Diagnosis&, Eigen::Index, Eigen::Index)> get;
  std::function<void(Diagnosis&, double, Eigen::Index, Eigen::Index)> set;
  bool is_whole = false;  ///< a word or a count, which cannot be NaN in a diagnosis
};

using ChainNumbers = std::vector<ChainNumber>;

template <class Part, class T>
ChainNumber of_loop(AssessmentNumberInfo info, Part Diagnosis::*part, T Part::*member) {
  info.scope = NumberScope::loop;
  return {std::move(info),
          [part, member](const Diagnosis& d, Eigen::Index, Eigen::Index) {
            return static_cast<double>(d.*part.*member);
          },
          [part, member](Diagnosis& d, double value, Eigen::Index, Eigen::Index) {
            d.*part.*member = static_cast<T>(value);
          },
          std::is_integral_v<T>};
}

ChainNumber of_loop(AssessmentNumberInfo info, double Diagnosis::*member) {
  info.scope = NumberScope::loop;
  return {std::move(info), [member](const Diagnosis& d, Eigen::Index, Eigen::Index) { return d.*member; },
          [member](Diagnosis& d, double value, Eigen::Index, Eigen::Index) { d.*member = value; }};
}

ChainNumber of_each_cv(AssessmentNumberInfo info, Eigen::VectorXd Diagnosis::*member) {
  info.scope = NumberScope::cv;
  return {std::move(info),
          [member](const Diagnosis& d, Eigen::Index cv, Eigen::Index) { return (d.*member)(cv); },
          [member](Diagnosis& d, double value, Eigen::Index cv, Eigen::Index) { (d.*member)(cv) = value; }};
}

ChainNumbers made_chain_numbers() {
  using M = MpmIndicator;
  const auto indicator = [](AssessmentNumberInfo info, auto M::*member) {
    return of_loop(std::move(info), &Diagnosis::indicator, member);
  };
  const auto alone = [](AssessmentNumberInfo info, double FaultsAlone::*member) {
    return of_loop(std::move(info), &Diagnosis::alone, member);
  };
  const std::string both = "; NaN unless the experiment has both faults";
  return {
      of_each_cv(
          {.name = "ivar", .meaning = "Ivar = var y / var y0 (3.24, 6.7)", .estimates_ivar_basis = true},
          &Diagnosis::ivar),
      of_each_cv({.name = "ivar_diag", .meaning = "Ivar_diag = var y / var y0_diag (4.14, 6.8)"},
                 &Diagnosis::ivar_diag),
      of_loop({.name = "location_margin",
               .meaning = "how much farther from 1 Ivar_diag of the located CV is than that of any other",
               .summarised = true,
               .label = "location margin"},
              &Diagnosis::location_margin),
      indicator({.name = "co_dkts", .meaning = "mean correlation of the differenced moving kurtosis (6.13)"},
                &M::co_dkts),
      indicator({.name = "co_dskn", .meaning = "mean correlation of the differenced moving skewness (6.14)"},
                &M::co_dskn),
      indicator({.name = "i_mpm",
                 .meaning = "I_MPM = max(co_dkts, co_dskn) of the located CV (6.15)",
                 .summarised = true,
                 .label = "I_{MPM}"},
                &M::i_mpm),
      indicator({.name = "co_kts", .meaning = "mean correlation of the moving kurtosis (5.15)"}, &M::co_kts),
      indicator({.name = "co_skn", .meaning = "mean correlation of the moving skewness (5.15)"}, &M::co_skn),
      indicator({.name = "windows_scanned", .meaning = "number of moving-window lengths"}, &M::scanned),
      indicator(
          {.name = "windows_used", .meaning = "number of window lengths behind the weakest of the means"},
          &M::used),
      alone({.name = "ivar_diag_mpm_alone",
             .meaning = "Ivar_diag of the affected CV with the mismatch alone" + both},
            &FaultsAlone::ivar_diag_mpm),
      alone({.name = "ivar_diag_ud_alone",
             .meaning = "Ivar_diag of the affected CV with the disturbance alone" + both},
            &FaultsAlone::ivar_diag_ud),
      alone({.name = "dominance_mpm", .meaning = "share of the mismatch in Ivar_diag (6.23)" + both},
            &FaultsAlone::dominance_mpm),
  };
}

/// A number of CvDiagnosis; `of` gives the part that has it.
template <class Part, class Of>
ChainNumber of_cv(const NumberColumn<Part>& column, Of of) {
  return {{.name = "cv_" + column.name,
           .scope = NumberScope::cv,
           .meaning = column.meaning,
           .unit = column.unit,
           .words = column.words},
          [get = column.value, of](const Diagnosis& d, Eigen::Index cv, Eigen::Index) {
            return get(of(d.cvs[static_cast<std::size_t>(cv)]));
          },
          [set = column.set, of](Diagnosis& d, double value, Eigen::Index cv, Eigen::Index) {
            set(of(d.cvs[static_cast<std::size_t>(cv)]), value);
          },
          !column.words.empty()};
}

ChainNumber acf_curve(const std::string& of, AcfFeatures AcfComparison::*record) {
  return {{.name = "cv_acf_" + of,
           .scope = NumberScope::cv_lag,
           .meaning = "autocorrelation of " + of + " about the setpoint of a CV that has one"},
          [record](const Diagnosis& d, Eigen::Index cv, Eigen::Index lag) {
            return (d.cvs[static_cast<std::size_t>(cv)].acf.*record).values(lag);
          },
          [record](Diagnosis& d, double value, Eigen::Index cv, Eigen::Index lag) {
            Eigen::VectorXd& values = (d.cvs[static_cast<std::size_t>(cv)].acf.*record).values;
            if (values.size() <= lag)
              values.conservativeResize(lag + 1);
            values(lag) = value;
          }};
}

ChainNumbers made_scenario_numbers() {
  const auto itself = [](auto& cv) -> auto& {
    return cv;
  };
  const auto distribution = [](auto& cv) -> auto& {
    return cv.distribution;
  };
  const auto acf = [](auto& cv) -> auto& {
    return cv.acf;
  };
  const std::vector<NumberColumn<CvDiagnosis>> own{
      {"sse", "1", "SSE = norm of y_sim - y (4.17), in the unit of the CV",
       [](const CvDiagnosis& cv) { return cv.sse; }, [](CvDiagnosis& cv, double value) { cv.sse = value; }},
      {"windows_scanned", "1", "number of moving-window lengths",
       [](const CvDiagnosis& cv) { return static_cast<double>(cv.distribution.mpm.scanned); },
       [](CvDiagnosis& cv, double value) { cv.distribution.mpm.scanned = static_cast<int>(value); }},
      {"windows_used", "1", "number of window lengths behind the weakest of the means",
       [](const CvDiagnosis& cv) { return static_cast<double>(cv.distribution.mpm.used); },
       [](CvDiagnosis& cv, double value) { cv.distribution.mpm.used = static_cast<int>(value); }}};
  ChainNumbers numbers;
  for (const auto& column : own)
    numbers.push_back(of_cv(column, itself));
  for (const auto& column : distribution_columns())
    numbers.push_back(of_cv(column, distribution));
  for (const auto& column : scatter_columns())
    numbers.push_back(of_cv(column, distribution));
  for (const auto& column : acf_columns())
    numbers.push_back(of_cv(column, acf));
  numbers.push_back(acf_curve("y", &AcfComparison::y));
  numbers.push_back(acf_curve("y0", &AcfComparison::y0));
  numbers.push_back(acf_curve("y0_diag", &AcfComparison::y0_diag));
  return numbers;
}

const ChainNumbers& of_every_study() {
  static const ChainNumbers numbers = made_chain_numbers();
  return numbers;
}

const ChainNumbers& of_scenarios() {
  static const ChainNumbers numbers = made_scenario_numbers();
  return numbers;
}

std::vector<AssessmentNumberInfo> infos(const ChainNumbers& numbers) {
  std::vector<AssessmentNumberInfo> list;
  for (const ChainNumber& number : numbers)
    list.push_back(number.info);
  return list;
}

void append(const ChainNumbers& numbers, const Diagnosis& diagnosis, std::vector<AssessmentNumber>& list) {
  for (const ChainNumber& number : numbers) {
    const bool of_loop = number.info.scope == NumberScope::loop;
    const bool of_lags = number.info.scope == NumberScope::cv_lag;
    const Eigen::Index cvs = of_loop ? 1 : diagnosis.ivar.size();
    const Eigen::Index lags = of_lags ? diagnosis.cvs.front().acf.y.values.size() : 1;
    for (Eigen::Index cv = 0; cv < cvs; ++cv)
      for (Eigen::Index lag = 0; lag < lags; ++lag)
        list.push_back(
            {number.info.name, number.get(diagnosis, cv, lag), of_loop ? -1 : cv, of_lags ? lag : -1});
  }
}

/// Puts back every number that the record has. An archive may have none in place of a word or a count: the
/// diagnosis then keeps the one that it begins with.
void put_back(const ChainNumbers& numbers, const AssessmentRecord& record, Diagnosis& diagnosis) {
  for (const ChainNumber& number : numbers) {
    const NumberPlace* const place = record.form->find(number.info.name);
    if (place == nullptr)
      continue;
    const double* value = record.numbers.data() + place->first;
    for (Eigen::Index cv = 0; cv < place->rows; ++cv)
      for (Eigen::Index column = 0; column < place->columns; ++column, ++value)
        if (!number.is_whole || !std::isnan(*value))
          number.set(diagnosis, *value, cv, column);
  }
}

}  // namespace

bool diagnoses(const AssessmentForm& form) {
  return form.find("i_mpm") != nullptr;
}

std::shared_ptr<const AssessmentForm> diagnosis_form(const Study& study) {
  MethodDescription description;
  description.locates_cvs = true;
  description.tells_sources = true;
  description.numbers = chain_number_infos();
  if (study.names_scenarios())
    for (const AssessmentNumberInfo& number : scenario_number_infos())
      description.numbers.push_back(number);
  return std::make_shared<const AssessmentForm>(std::move(description), study);
}

const std::vector<AssessmentNumberInfo>& chain_number_infos() {
  static const std::vector<AssessmentNumberInfo> list = infos(of_every_study());
  return list;
}

const std::vector<AssessmentNumberInfo>& scenario_number_infos() {
  static const std::vector<AssessmentNumberInfo> list = infos(of_scenarios());
  return list;
}

std::vector<AssessmentNumber> chain_numbers(const Diagnosis& diagnosis) {
  std::vector<AssessmentNumber> list;
  append(of_every_study(), diagnosis, list);
  if (!diagnosis.cvs.empty())
    append(of_scenarios(), diagnosis, list);
  return list;
}

Diagnosis diagnosis_of(const AssessmentRecord& record) {
  Diagnosis diagnosis;
  if (!record.answered())
    return diagnosis;
  diagnosis.impactful = record.flagged;
  diagnosis.predicted_cv = record.predicted_cv;
  diagnosis.predicted_source = record.predicted_source;
  const Eigen::MatrixXd flagged = record.values("cv_flagged");
  const Eigen::Index ny = flagged.rows();
  diagnosis.ivar.resize(ny);
  diagnosis.ivar_diag.resize(ny);
  put_back(of_every_study(), record, diagnosis);
  if (record.form->find(of_scenarios().front().info.name) == nullptr)
    return diagnosis;
  diagnosis.cvs.resize(static_cast<std::size_t>(ny));
  put_back(of_scenarios(), record, diagnosis);
  for (Eigen::Index cv = 0; cv < ny; ++cv) {
    CvDiagnosis& of_cv = diagnosis.cvs[static_cast<std::size_t>(cv)];
    of_cv.flagged = flagged(cv) == 1.0;
    if (const double source = record.number("cv_source", cv); of_cv.flagged && !std::isnan(source))
      of_cv.source = static_cast<FaultSource>(static_cast<int>(source));
  }
  return diagnosis;
}

}  // namespace mpm
