#include "analysis/methods/source_probabilities.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/non_finite.hpp"

namespace mpm {

const std::vector<AssessmentNumberInfo>& source_probability_numbers() {
  static const std::vector<AssessmentNumberInfo> numbers{
      {"p_healthy", NumberScope::loop, "stated probability of no fault"},
      {"p_mpm", NumberScope::loop, "stated probability of a mismatch alone"},
      {"p_ud", NumberScope::loop, "stated probability of an unmeasured disturbance alone"},
      {"p_both", NumberScope::loop, "stated probability of both"},
      {"p_other", NumberScope::loop, "stated probability of another fault: a sensor, a valve, the data"}};
  return numbers;
}

bool states_probabilities(const MethodDescription& method) {
  const auto has = [&method](const AssessmentNumberInfo& of) {
    return std::any_of(method.numbers.begin(), method.numbers.end(), [&of](const AssessmentNumberInfo& each) {
      return each.name == of.name && each.scope == NumberScope::loop;
    });
  };
  return std::all_of(source_probability_numbers().begin(), source_probability_numbers().end(), has);
}

std::optional<SourceProbabilities> stated_probabilities(const AssessmentRecord& said) {
  if (!said.answered() || !states_probabilities(said.form->method()))
    return std::nullopt;
  SourceProbabilities stated;
  for (std::size_t i = 0; i < stated.size(); ++i)
    stated[i] = said.number(source_probability_numbers()[i].name);
  const double sum = std::accumulate(stated.begin(), stated.end(), 0.0);
  if (!(sum > 0.0 && std::isfinite(sum)) || *std::min_element(stated.begin(), stated.end()) < 0.0)
    return std::nullopt;
  for (double& probability : stated)
    probability /= sum;
  return stated;
}

double log_score(const SourceProbabilities& stated, FaultSource truth) {
  const double p = std::max(stated[static_cast<std::size_t>(truth)], kLeastScoredProbability);
  return std::log(p) / std::log(kLeastScoredProbability);
}

double brier_score(const SourceProbabilities& stated, FaultSource truth) {
  double sum = 0.0;
  for (std::size_t i = 0; i < stated.size(); ++i)
    sum += std::pow(stated[i] - (i == static_cast<std::size_t>(truth) ? 1.0 : 0.0), 2);
  return sum / 2.0;
}

void Reliability::add(const SourceProbabilities& stated, FaultSource truth) {
  const auto likeliest = std::max_element(stated.begin(), stated.end());
  Bin& bin = bins_[std::min(kBins - 1, static_cast<std::size_t>(*likeliest * kBins))];
  bin.stated += *likeliest;
  ++bin.count;
  bin.right +=
      static_cast<std::size_t>(likeliest - stated.begin()) == static_cast<std::size_t>(truth) ? 1 : 0;
}

void Reliability::add(const Reliability& more) {
  for (std::size_t i = 0; i < kBins; ++i) {
    bins_[i].stated += more.bins_[i].stated;
    bins_[i].count += more.bins_[i].count;
    bins_[i].right += more.bins_[i].right;
  }
}

double Reliability::error() const {
  double sum = 0.0;
  for (const Bin& bin : bins_)
    sum += std::abs(bin.stated - static_cast<double>(bin.right));
  return count() == 0 ? kNaN : sum / static_cast<double>(count());
}

std::int64_t Reliability::count() const {
  return std::accumulate(bins_.begin(), bins_.end(), std::int64_t{0},
                         [](std::int64_t sum, const Bin& bin) { return sum + bin.count; });
}

}  // namespace mpm
