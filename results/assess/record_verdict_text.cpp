#include "results/assess/record_verdict_text.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "results/assess/repair_form.hpp"
#include "results/document/document.hpp"
#include "results/text/experiment_text.hpp"
#include "scenarios/toml/toml_literal.hpp"

namespace mpm {
namespace {

using Lines = std::vector<std::string>;

/// Formats a probability in whole percent, but never as 0 or 100 %.
std::string whole_percent_text(int permille) {
  return permille > 990  ? "more than 99 %"
         : permille < 10 ? "less than 1 %"
                         : fmt::format("{:.0f} %", permille / 10.0);
}

/// "12 % (5 to 20 %)"
std::string promise_text(const PromisedGain& promise) {
  const auto percent = [](double share) { return std::lround(100.0 * share); };
  return fmt::format("{} % ({} to {} %)", percent(promise.gain), percent(promise.lower),
                     percent(promise.upper));
}

/// Writes one verdict.
class VerdictWriter {
 public:
  VerdictWriter(const RecordVerdict& verdict, const Study& study, const Lines& stamps)
      : verdict_(verdict), study_(study), stamps_(stamps) {}

  RecordVerdictText text() const {
    return {.model = model(),
            .loop = loop(),
            .action = action(),
            .benchmark = benchmark(),
            .scores = scores(),
            .costs = costs(),
            .probabilities = probabilities()};
  }

 private:
  std::string cv(Eigen::Index place) const { return cv_name(study_, place); }
  std::string mv(Eigen::Index place) const { return place < 0 ? "an MV" : mv_name(study_, place); }
  std::string stamp(Eigen::Index sample) const { return stamps_[static_cast<std::size_t>(sample)]; }

  std::string since() const {
    const std::optional<FaultOnset>& onset = verdict_.model.since;
    return onset ? fmt::format(" since {} ({} to {})", stamp(onset->sample), stamp(onset->earliest),
                               stamp(onset->latest))
                 : "";
  }

  Lines names_of(const std::vector<UnexplainedPart>& parts, bool noisy) const {
    Lines names;
    for (const UnexplainedPart& part : parts)
      if (part.is_noise == noisy)
        names.push_back(cv(part.cv));
    return names;
  }

  /// Says what the source is if the model fails.
  std::string what() const {
    const RecordVerdict::Model& model = verdict_.model;
    const std::string at = cv(model.at.front().cv);
    std::string mismatch = model.mismatch ? mismatch_sentence(study_, *model.mismatch)
                           : model.md >= 0
                               ? fmt::format("the response of {} to {} is not that of the model", at,
                                             study_.plant.mds[static_cast<std::size_t>(model.md)].name)
                               : fmt::format("a channel of {} is not that of the model", at);
    if (model.drifts)
      return fmt::format(
          "{} {} away from the model, by its sensor or by an unmeasured disturbance that {}: the loop "
          "cannot tell which",
          model.sensor_cv < 0 ? at : cv(model.sensor_cv), model.jumps ? "jumps" : "drifts",
          model.jumps ? "stays" : "grows");
    switch (model.source) {
      case RecordSource::mismatch:
        return mismatch;
      case RecordSource::both:
        return mismatch + ", and an unmeasured disturbance is there as well";
      case RecordSource::disturbance:
        return fmt::format("an unmeasured disturbance on {}, and not the model", at);
      case RecordSource::sensor: {
        const std::string sensor = model.sensor_cv < 0 ? at : cv(model.sensor_cv);
        return model.stuck
                   ? fmt::format("the sensor of {} is stuck: it shows one value from {} to {}", sensor,
                                 stamp(model.stuck->first), stamp(model.stuck->end - 1))
                   : fmt::format("the sensor of {} {} away", sensor, model.jumps ? "jumps" : "drifts");
      }
      case RecordSource::valve:
        return fmt::format("the valve of {} sticks", mv(model.valve_mv));
      case RecordSource::data:
        return late();
      case RecordSource::nothing:
      case RecordSource::unknown:
        break;
    }
    return "none of the faults that are known here fits";
  }

  /// "all CVs are measured half a sample later than their rows say, as averages over a row are"
  std::string late() const {
    constexpr double kAverage = 0.5;
    const RecordVerdict::Model& model = verdict_.model;
    const double size = std::abs(model.late);
    const std::string by = size == kAverage ? "half a sample"
                           : size == 1.0    ? "one row"
                                            : fmt::format("{:g} rows", size);
    Lines names;
    for (const Eigen::Index place : model.late_cvs)
      names.push_back(cv(place));
    const std::string who = study_.cv_count() == 1 ? cv(0) + " is"
                            : names.empty()        ? "all CVs are"
                                                   : in_a_row(names) + (names.size() == 1 ? " is" : " are");
    if (size == 0.0)
      return "the clock of the record is off";
    if (size == kAverage)
      return fmt::format("{} measured {} {} than the rows say, as averages over a row are", who, by,
                         model.late < 0.0 ? "later" : "earlier");
    return fmt::format("{} {} too {} against all MVs", who, by, model.late < 0.0 ? "early" : "late");
  }

  /// "Most likely (84 %)", or "Likeliest of the faults (30 %)" if something else is more likely.
  std::string sure() const {
    const RecordVerdict::Model& model = verdict_.model;
    if (!model.probabilities)
      return "Likeliest";
    const auto shares = permille(*model.probabilities);
    const auto of = [&shares](RecordSource source) { return shares[static_cast<std::size_t>(source)]; };
    const int share =
        model.drifts ? of(RecordSource::sensor) + of(RecordSource::disturbance) : of(model.source);
    return fmt::format(
        "{} ({})",
        share >= *std::max_element(shares.begin(), shares.end()) ? "Most likely" : "Likeliest of the faults",
        whole_percent_text(share));
  }

  std::string model() const {
    if (!verdict_.model.late_is_corrected)
      return model_alone();
    return fmt::format("{} In the record {}; this is corrected.", model_alone(), late());
  }

  std::string model_alone() const {
    const RecordVerdict::Model& model = verdict_.model;
    if (model.answer == ModelAnswer::explains)
      return "The model explains the record.";
    if (model.answer == ModelAnswer::cannot_tell)
      return std::isnan(model.score)
                 ? "The record cannot tell: no CV has enough samples."
                 : "The record cannot tell: no gain that is wrong by half would show in it.";
    Lines noisy, sentences;
    for (const UnexplainedPart& part : model.at)
      if (part.is_noise)
        noisy.push_back(
            fmt::format("The model does not explain {}: its noise is {:.2g} times that of the study.",
                        cv(part.cv), part.score));
    if (const Lines names = names_of(model.at, false); !names.empty()) {
      sentences.push_back(fmt::format("The model no longer explains {}{}. {}: {}.", in_a_row(names), since(),
                                      sure(), what()));
    }
    sentences.insert(model.at.front().is_noise ? sentences.begin() : sentences.end(), noisy.begin(),
                     noisy.end());
    return fmt::format("{}", fmt::join(sentences, " "));
  }

  std::string ratio_text(const CvCost& cost) const {
    constexpr double kBeyond = 100.0;
    return cost.ratio > kBeyond
               ? fmt::format("{} more than {:.0f} times", cv(cost.cv), kBeyond)
               : fmt::format("{} {} times", cv(cost.cv), told_apart(cost.ratio, cost.threshold).first);
  }

  std::string loop() const {
    const RecordVerdict::Loop& loop = verdict_.loop;
    Lines dearer, all;
    for (const CvCost& cost : loop.costs) {
      all.push_back(ratio_text(cost));
      if (cost.is_dearer())
        dearer.push_back(all.back());
    }
    const std::string listed =
        all.empty() ? "" : fmt::format(" ({} the loop as designed)", fmt::join(all, ", "));
    std::string text;
    switch (loop.answer) {
      case LoopAnswer::dearer:
        text = fmt::format("It costs more than the loop as designed{}: {}.", since(), in_a_row(dearer));
        if (verdict_.model.answer == ModelAnswer::fails && !verdict_.names_dearest())
          text += fmt::format(" {} costs most, but the model explains it.", cv(loop.costs.front().cv));
        break;
      case LoopAnswer::as_designed:
        text = fmt::format("{}{}.",
                           verdict_.model.answer == ModelAnswer::fails ? "That costs nothing today"
                                                                       : "It costs no more than designed",
                           listed);
        break;
      case LoopAnswer::cannot_tell:
        text = all.empty() ? "No CV has a setpoint or a range: nothing says what the loop costs."
                           : fmt::format("Whether it costs more than is usual is not known{}.", listed);
        break;
    }
    if (!verdict_.controller_is_alike)
      text += " The controller of the study is not the one that ran.";
    return text;
  }

  std::string action() const {
    const RecordVerdict::Action& action = verdict_.action;
    const std::string channel = action.channel ? channel_name(study_, *action.channel) : "";
    switch (action.kind) {
      case ActionKind::nothing:
        return "Nothing.";
      case ActionKind::repair:
        return fmt::format(
            "Repair {}: test it on the plant, and put into the model what the test confirms. This is "
            "expected to take "
            "away {} of what the loop costs{}.",
            channel, promise_text(*action.promise), changes());
      case ActionKind::sensor:
        if (verdict_.model.drifts && !verdict_.model.at.front().is_noise)
          return fmt::format(
              "Look at the sensor of {0}: hold it against another measurement. If it is right, look for what "
              "disturbs {0}; leave the model as it is.",
              cv(action.cv));
        return verdict_.model.source == RecordSource::sensor && !verdict_.model.at.front().is_noise
                   ? fmt::format(
                         "Look at the sensor of {}: hold it against another measurement before anything is "
                         "done about "
                         "the model.",
                         cv(action.cv))
                   : fmt::format(
                         "Look at the sensor of {}, and at the noise of the study "
                         "(simulation.noise_standard_deviation).",
                         cv(action.cv));
      case ActionKind::valve:
        return fmt::format(
            "Check the valve of {} and its positioner before the model: move it in small steps, and "
            "see from which size on the plant answers.",
            mv(action.mv));
      case ActionKind::column:
        return "Look at how the historian stamps and averages the columns, correct that, and assess again.";
      case ActionKind::controller:
        return "Change the controller of the study to the one that ran (setpoints, limits, costs, tuning), "
               "and assess again; leave the model as it is.";
      case ActionKind::limit:
        return "Look at tuning, setpoints, limits and the operating point of that time; leave the model as "
               "it is.";
      case ActionKind::disturbance:
        return fmt::format("Look for what disturbs {} from outside of the loop; leave the model as it is.",
                           cv(action.cv));
      case ActionKind::test:
        return test(channel);
      case ActionKind::wait:
        break;
    }
    return wait(channel);
  }

  std::string changes() const {
    Lines changes;
    const Eigen::VectorXd& ratio = verdict_.action.promise->variance_ratio;
    for (Eigen::Index cv = 0; cv < ratio.size(); ++cv)
      changes.push_back(fmt::format("{} {:+d} %", this->cv(cv), std::lround(100.0 * (ratio(cv) - 1.0))));
    return changes.empty() ? "" : fmt::format(" (costs: {})", fmt::join(changes, ", "));
  }

  std::string test(const std::string& channel) const {
    const RecordVerdict::Action& action = verdict_.action;
    if (channel.empty())
      return fmt::format(
          "Test the channels of {} with steps, and look at sensors, valves, limits and operators of that "
          "time first.",
          cv(verdict_.named_cv()));
    if (action.worsened.empty() && action.promise && !(action.promise->gain > kNoGain))
      return fmt::format(
          "Test {} with steps, and look for other causes of the cost: by this record alone, its repair is "
          "expected to gain nothing ({}).",
          channel, promise_text(*action.promise));
    if (action.worsened.empty())
      return fmt::format("Test {} with steps: {}.", channel,
                         verdict_.model.mismatch && !std::isnan(verdict_.model.mismatch->size)
                             ? "what its repair would bring cannot be told from this record"
                             : "the record does not tell how to correct it");
    Lines worse;
    for (const Eigen::Index each : action.worsened)
      worse.push_back(cv(each));
    return fmt::format(
        "Test {} with steps. Do not put it into the controller before: {} would cost more with it.", channel,
        in_a_row(worse));
  }

  std::string wait(const std::string& channel) const {
    const RecordVerdict::Action& action = verdict_.action;
    if (!channel.empty() && action.promise)
      return fmt::format(
          "Wait: leave {} as it is, its repair is expected to {}. Test it before the loop is tuned tighter.",
          channel,
          action.promise->gain > kNoGain
              ? fmt::format("take away only {} of what the loop costs", promise_text(*action.promise))
              : fmt::format("gain nothing ({})", promise_text(*action.promise)));
    if (!channel.empty())
      return fmt::format("Wait: leave {} as it is. Test it before the loop is tuned tighter.", channel);
    if (verdict_.model.answer == ModelAnswer::fails)
      return fmt::format("Wait: leave the model as it is, and assess {} again with the next record.",
                         cv(verdict_.named_cv()));
    if (!verdict_.has_trials)
      return "Wait: assess again with simulated records (--trials), which show what is usual.";
    return "Wait for a record in which setpoints or disturbances move more.";
  }

  std::string benchmark() const {
    const RecordBenchmark& benchmark = verdict_.benchmark;
    const bool has_period = benchmark.first < benchmark.end;
    const std::string from = has_period ? stamp(benchmark.first) : "",
                      to = has_period ? stamp(benchmark.end - 1) : "";
    switch (benchmark.use) {
      case BenchmarkUse::named:
        return fmt::format(
            "The benchmark is {} to {}, which the study names: what the plant did then is its habit, and no "
            "fault.",
            from, to);
      case BenchmarkUse::found:
        return fmt::format(
            "The benchmark is {} to {}, where the model is best: what the plant did then is its habit, even "
            "if it was a fault.",
            from, to);
      case BenchmarkUse::proposed:
        return fmt::format(
            "No benchmark is named: what this plant always does counts as a fault. If the loop ran well "
            "from {} to {}, where the model is best, put benchmark = [{}, {}] into [data] and assess again.",
            from, to, toml_literal(from), toml_literal(to));
      case BenchmarkUse::unfit:
        return fmt::format(
            "No benchmark is named, and none was found: {}. What this plant always does counts as a fault.",
            has_period ? fmt::format("even from {} to {}, where the model is best, a channel of {} is wrong",
                                     from, to, cv(benchmark.cv))
                       : "in no period do all CVs have values and all MVs move");
      case BenchmarkUse::none:
        break;
    }
    if (!benchmark.is_wanted)
      return "No benchmark is wanted (data.benchmark).";
    return verdict_.model.answer == ModelAnswer::explains
               ? "No benchmark is named, and none is needed: the model explains the record without one."
               : "No benchmark is named.";
  }

  Lines scores() const {
    const RecordVerdict::Model& model = verdict_.model;
    Lines lines;
    for (const UnexplainedPart& part : model.at) {
      const auto [score, threshold] = told_apart(part.score, part.threshold);
      lines.push_back(fmt::format("{}: {} {}, threshold {}: not explained.", cv(part.cv),
                                  part.is_noise ? "noise" : "score", score, threshold));
    }
    if (lines.empty() && !std::isnan(model.score)) {
      const auto [score, threshold] = told_apart(model.score, model.threshold);
      lines.push_back(fmt::format("All CVs: score {}, threshold {}: explained.", score, threshold));
    }
    return lines;
  }

  Lines costs() const {
    Lines lines;
    for (const CvCost& cost : verdict_.loop.costs) {
      const auto [ratio, threshold] = told_apart(cost.ratio, cost.threshold);
      lines.push_back(std::isnan(cost.threshold)
                          ? fmt::format("{}: {} times, threshold not known.", cv(cost.cv), ratio)
                          : fmt::format("{}: {} times, threshold {}: {}.", cv(cost.cv), ratio, threshold,
                                        cost.is_dearer() ? "costs more" : "as designed"));
    }
    return lines;
  }

  std::string probabilities() const {
    if (!verdict_.model.probabilities)
      return "";
    const auto shares = permille(*verdict_.model.probabilities);
    Lines parts;
    for (std::size_t place = 0; place < kRecordSources; ++place)
      parts.push_back(
          fmt::format("{} {:.1f} %", source_text(static_cast<RecordSource>(place)), shares[place] / 10.0));
    return fmt::format("Probabilities: {}.", fmt::join(parts, ", "));
  }

  const RecordVerdict& verdict_;
  const Study& study_;
  const Lines& stamps_;
};

}  // namespace

RecordVerdictText record_verdict_text(const RecordVerdict& verdict, const Study& study,
                                      const std::vector<std::string>& stamps) {
  return VerdictWriter(verdict, study, stamps).text();
}

std::string mismatch_sentence(const Study& study, const NamedMismatch& named) {
  const std::string channel =
      fmt::format("{}/{}", cv_name(study, named.channel.cv), mv_name(study, named.channel.mv));
  const bool has_size = !std::isnan(named.size);
  const std::string size = estimate_text(named.size, named.lower, named.upper, named.bound);
  const std::string times =
      has_size ? fmt::format("{} times that of the model", size) : "not that of the model";
  const std::string& unit = study.plant.time_unit;
  switch (named.parameter) {
    case MismatchParameter::gain:
      return fmt::format("the gain of {} in the plant is {}", channel, times);
    case MismatchParameter::time_constant:
      return fmt::format("the time constant of {} in the plant is {}", channel, times);
    case MismatchParameter::dead_time:
      return fmt::format("the dead time of {} in the plant is {}", channel,
                         has_size ? dead_time_text(named.size, named.lower, named.upper, named.bound, unit)
                                  : "not that of the model");
    case MismatchParameter::second_order:
      return fmt::format("{} has a further lag{}", channel,
                         has_size ? fmt::format(" of {} {}", size, unit) : "");
    case MismatchParameter::inverse_response:
      return fmt::format("{} has an inverse response{}", channel,
                         has_size ? fmt::format(" of {} {}", size, unit) : "");
    case MismatchParameter::sign:
      return fmt::format("the gain of {} has the other sign in the plant", channel);
    case MismatchParameter::channel:
      break;
  }
  return fmt::format("{} differs from the model", channel);
}

std::pair<std::string, std::string> told_apart(double a, double b) {
  constexpr int kFewest = 3, kMost = 17;
  constexpr double kPlain = 1000.0;  // from here on, all digits before the decimal point
  const auto text = [](double number, int digits) {
    return std::abs(number) < kPlain || !std::isfinite(number)
               ? fmt::format("{:.{}g}", number, digits)
               : fmt::format("{:.{}f}", number, digits - kFewest);
  };
  for (int digits = kFewest;; ++digits) {
    std::pair<std::string, std::string> texts{text(a, digits), text(b, digits)};
    if (texts.first != texts.second || a == b || digits == kMost)
      return texts;
  }
}

std::array<int, kRecordSources> permille(const OfSources& probabilities) {
  constexpr int kWhole = 1000;
  std::array<int, kRecordSources> shares{};
  for (std::size_t place = 0; place < kRecordSources; ++place)
    shares[place] = std::max(1, static_cast<int>(std::lround(kWhole * probabilities.each[place])));
  // The largest share takes the remainder of the rounding.
  *std::max_element(shares.begin(), shares.end()) +=
      kWhole - std::accumulate(shares.begin(), shares.end(), 0);
  return shares;
}

std::string source_text(RecordSource source) {
  switch (source) {
    case RecordSource::nothing:
      return "nothing";
    case RecordSource::mismatch:
      return "a mismatch of the model";
    case RecordSource::disturbance:
      return "an unmeasured disturbance";
    case RecordSource::both:
      return "both";
    case RecordSource::sensor:
      return "a sensor";
    case RecordSource::valve:
      return "a valve that sticks";
    case RecordSource::data:
      return "the clock of the record";
    case RecordSource::unknown:
      break;
  }
  return "none of these";
}

}  // namespace mpm
