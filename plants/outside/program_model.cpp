#include "plants/outside/program_model.hpp"

#include <cstddef>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/system/child_process.hpp"
#include "base/system/foreign_text.hpp"

namespace mpm {
namespace {

using PlantJson = nlohmann::ordered_json;

constexpr std::size_t kShownOfAnswer = 200;  // bytes, in a message

std::vector<double> list_of(const Eigen::Ref<const Eigen::VectorXd>& numbers) {
  return {numbers.begin(), numbers.end()};
}

class ProgramSimulation final : public ForeignSimulation {
 public:
  ProgramSimulation(const ProgramSettings& settings, double sample_time, double time_limit)
      : settings_(settings), sample_time_(sample_time), time_limit_(time_limit) {}

  void start(const Eigen::VectorXd& parameters, const Eigen::VectorXd&) override {
    PlantJson named = PlantJson::object();
    for (std::size_t i = 0; i < settings_.parameters.size(); ++i)
      named[settings_.parameters[i]] = parameters(static_cast<Eigen::Index>(i));
    ask({{"call", "reset"}, {"parameters", named}, {"sample_time", sample_time_}});
  }
  void change(const Eigen::VectorXd&) override {
    throw ForeignFailure("the parameters of a program come with its reset");
  }
  Eigen::VectorXd step(const Eigen::VectorXd& input) override {
    const PlantJson answer = ask({{"call", "step"},
                                  {"u", list_of(input.head(settings_.mvs))},
                                  {"d", list_of(input.segment(settings_.mvs, settings_.mds))},
                                  {"inner", list_of(input.tail(settings_.inner))}});
    const auto y = answer.find("y");
    Eigen::VectorXd outputs(settings_.outputs);
    const bool fits =
        y != answer.end() && y->is_array() && y->size() == static_cast<std::size_t>(outputs.size());
    for (Eigen::Index i = 0; i < outputs.size(); ++i) {
      const bool is_number = fits && (*y)[static_cast<std::size_t>(i)].is_number();
      if (!is_number)  // JSON has no number that is not finite
        throw ForeignFailure(fmt::format("an answer to step without \"y\" of {} numbers: {}", outputs.size(),
                                         foreign_text(answer.dump(-1, ' ', true), kShownOfAnswer)));
      outputs(i) = (*y)[static_cast<std::size_t>(i)].get<double>();
    }
    return outputs;
  }

 private:
  PlantJson ask(const PlantJson& request) {
    std::string line;
    try {
      if (!program_)
        program_.emplace(settings_.command);
      const ChildProcess::Deadline deadline = ChildProcess::in_seconds(time_limit_);
      program_->send(request.dump(), deadline);
      line = program_->receive(deadline);
    } catch (const ChildFailure& error) {
      program_.reset();
      throw ForeignFailure(error.what());
    }
    PlantJson answer = PlantJson::parse(line, nullptr, false);
    if (!answer.is_object())
      throw ForeignFailure(
          fmt::format("an answer that is not a JSON object: {}", foreign_text(line, kShownOfAnswer)));
    if (const auto error = answer.find("error"); error != answer.end())
      throw ForeignFailure(
          fmt::format("it says: {}", foreign_text(error->dump(-1, ' ', true), kShownOfAnswer)));
    return answer;
  }

  ProgramSettings settings_;
  double sample_time_, time_limit_;
  std::optional<ChildProcess> program_;
};

class ProgramModel final : public ForeignModel {
 public:
  ProgramModel(ProgramSettings settings, const ForeignOptions& options)
      : ForeignModel(options), settings_(std::move(settings)) {}

  std::string description() const override {
    return fmt::format("'{}' {} {} {}", fmt::join(settings_.command, "' '"), options().settle,
                       options().settle_tolerance, options().time_limit);
  }
  void load() const override {}  // a missing program shows when it is started
  std::vector<std::string> command() const override { return settings_.command; }
  Eigen::Index output_count() const override { return settings_.outputs; }
  bool is_tunable(std::size_t) const override { return false; }
  std::unique_ptr<ForeignSimulation> simulation(double sample_time) const override {
    return std::make_unique<ProgramSimulation>(settings_, sample_time, options().time_limit);
  }

 private:
  ProgramSettings settings_;
};

}  // namespace

std::shared_ptr<const ForeignModel> program_model(ProgramSettings settings, const ForeignOptions& options) {
  return std::make_shared<const ProgramModel>(std::move(settings), options);
}

}  // namespace mpm
