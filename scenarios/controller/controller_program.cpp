#include "scenarios/controller/controller_program.hpp"

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <mutex>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "base/system/waiting_programs.hpp"
#include "scenarios/controller/model_json.hpp"
#include "solvers/mpc.hpp"

namespace mpm {
namespace {

using ProgramJson = nlohmann::ordered_json;

constexpr const char* kControllerPlace = "controller program";
constexpr std::size_t kShownOfJson = 200;  // bytes, in a message

std::string shown(const ProgramJson& json) {
  return json.dump(-1, ' ', true, ProgramJson::error_handler_t::replace).substr(0, kShownOfJson);
}

/// The numbers under `key`, one for each MV, all finite.
Eigen::VectorXd mvs_of(const ProgramJson& answer, const char* key, Eigen::Index count) {
  const auto list = answer.find(key);
  const bool fits =
      list != answer.end() && list->is_array() && list->size() == static_cast<std::size_t>(count);
  Eigen::VectorXd u = Eigen::VectorXd::Constant(count, kNaN);
  for (Eigen::Index i = 0; fits && i < count; ++i)
    if (const ProgramJson& value = (*list)[static_cast<std::size_t>(i)]; value.is_number())
      u(i) = value.get<double>();
  if (!u.allFinite())
    throw InputError(kControllerPlace, shown(answer),
                     fmt::format("\"{}\" with {} finite numbers, one for each MV", key, count));
  return u;
}

void refuse_unknown_keys(const ProgramJson& answer, std::initializer_list<const char*> known) {
  for (const auto& item : answer.items())
    if (std::find(known.begin(), known.end(), item.key()) == known.end())
      throw InputError(kControllerPlace, fmt::format("the key '{}' in {}", item.key(), shown(answer)),
                       fmt::format("{}", fmt::join(known, ", ")));
}

}  // namespace

/// The running programs of a study, and what they say about themselves.
class ControllerTalks {
 public:
  ControllerTalks(std::vector<std::string> command, double time_limit)
      : programs_(kControllerPlace, std::move(command), time_limit) {}

  const std::vector<std::string>& command() const { return programs_.command(); }
  double time_limit() const { return programs_.time_limit(); }

  /// Takes a program that waits, or starts a new one. Throws ChildFailure and InputError.
  std::unique_ptr<RunningProgram> take(const std::string& context) {
    std::unique_ptr<RunningProgram> running = programs_.take(context);
    if (std::exchange(running->is_new, false)) {
      const bool on_model = on_model_of(running->talk.ask({{"call", "describe"}}));
      const std::lock_guard lock(mutex_);
      on_model_ = on_model;
    }
    return running;
  }

  void give_back(std::unique_ptr<RunningProgram> running) { programs_.give_back(std::move(running)); }

  std::optional<bool> on_model() {
    const std::lock_guard lock(mutex_);
    return on_model_;
  }

 private:
  static bool on_model_of(const ProgramJson& description) {
    refuse_unknown_keys(description, {"on_model"});
    const auto on_model = description.find("on_model");
    if (on_model != description.end() && !on_model->is_boolean())
      throw InputError(kControllerPlace, shown(description), "\"on_model\": true or false");
    return on_model == description.end() || on_model->get<bool>();
  }

  WaitingPrograms programs_;
  std::mutex mutex_;
  std::optional<bool> on_model_;
};

namespace {

class ProgramController final : public Controller {
 public:
  ProgramController(std::shared_ptr<ControllerTalks> talks, const PlantModel& plant,
                    const MpcOptions& options, Eigen::Index samples, const QpSolverFactory& factory)
      : talks_(std::move(talks)),
        G_(plant.G),
        options_(options),
        factory_(factory),
        nu_(static_cast<Eigen::Index>(plant.mvs.size())),
        soft_(options.cv_soft),
        off_(SwitchedOff::none(G_.rows(), nu_)),
        y_set_(Eigen::VectorXd::Zero(G_.rows())) {
    ProgramJson context{{"call", "context"}};
    context.update(loop_context_json(plant, options, samples));
    context_ = context.dump();
  }
  ProgramController(const ProgramController&) = delete;
  ProgramController& operator=(const ProgramController&) = delete;
  ~ProgramController() override {
    if (running_)
      talks_->give_back(std::move(running_));
  }

  void reset(const Eigen::Ref<const Eigen::VectorXd>& u,
             const Eigen::Ref<const Eigen::VectorXd>& d) override {
    failure_.clear();
    move_ = {.status = ControlStatus::ok, .u = u, .u_target = u};
    acting_ = u;
    Eigen::VectorXd input(u.size() + d.size());
    input << u, d;
    guarded([&](std::unique_ptr<RunningProgram>& running) {
      if (!running)
        running = talks_->take(context_);
      if (running->context != context_) {
        refuse_unknown_keys(asked(running->talk.ask(ProgramJson::parse(context_))), {});
        running->context = context_;
      }
      const Eigen::VectorXd y = G_.steady_output(input);
      const ProgramJson start{
          {"call", "reset"}, {"u", vector_json(u)}, {"d", vector_json(d)}, {"y", vector_json(y)}};
      refuse_unknown_keys(asked(running->talk.ask(start)), {});
    });
  }

  const ControlMove& step(const Eigen::Ref<const Eigen::VectorXd>& y,
                          const Eigen::Ref<const Eigen::VectorXd>& d) override {
    move_.status = ControlStatus::ok;
    guarded([&](const std::unique_ptr<RunningProgram>& running) {
      if (!running)
        throw InputError("a step of a program that was not reset");
      ProgramJson question{{"call", "step"},
                           {"y", vector_json(y)},
                           {"d", vector_json(d)},
                           {"u", vector_json(acting_)},
                           {"y_set", vector_json(setpoints())},
                           {"cv_soft", limits_json(soft_)}};
      if (off_.has_any()) {
        question["mv_off"] = vector_json(off_.position);
        question["cv_off"] = std::vector<bool>(off_.cvs.begin(), off_.cvs.end());
      }
      take_move(asked(running->talk.ask(question)));
    });
    acting_ = move_.u;
    return move_;
  }

  void set_acting(const Eigen::Ref<const Eigen::VectorXd>& u) override { acting_ = u; }
  void set_cv_soft(const Limits& limits) override { soft_ = limits; }
  void set_setpoints(const Eigen::Ref<const Eigen::VectorXd>& y_set) override { y_set_ = y_set; }
  void set_off(const SwitchedOff& off) override {
    off.validate(G_.rows(), nu_);
    off_ = off;
  }

  Eigen::VectorXd nominal_target(const Eigen::Ref<const Eigen::VectorXd>& d) override {
    Mpc built_in(G_, nu_, options_, factory_);
    built_in.set_cv_soft(soft_);
    built_in.set_setpoints(y_set_);
    return built_in.nominal_target(d);
  }

  std::string failure() const override { return failure_; }

 private:
  /// Does the work with the program. An error of the program ends the loop; any error ends the program, which
  /// may be out of step.
  template <class Work>
  void guarded(Work work) {
    if (failure_.empty()) {
      std::unique_ptr<RunningProgram> running = std::move(running_);
      try {
        work(running);
        running_ = std::move(running);
        return;
      } catch (const ChildFailure& error) {
        failure_ = error.what();
      } catch (const InputError& error) {
        failure_ = error.what();
      }
    }
    move_.status = ControlStatus::failed;
  }

  static ProgramJson asked(ProgramJson answer) {
    if (const auto error = answer.find("error"); error != answer.end())
      throw InputError(fmt::format("the {} says: {}", kControllerPlace, shown(*error)));
    return answer;
  }

  void take_move(const ProgramJson& answer) {
    refuse_unknown_keys(answer, {"u", "u_target", "infeasible"});
    if (const auto infeasible = answer.find("infeasible");
        infeasible != answer.end() && *infeasible != ProgramJson(false)) {
      if (*infeasible != ProgramJson(true))
        throw InputError(kControllerPlace, shown(answer), "\"infeasible\": true or false");
      move_.status = ControlStatus::infeasible;
      return;
    }
    move_.u = mvs_of(answer, "u", nu_).cwiseMax(options_.mv_hard.lower).cwiseMin(options_.mv_hard.upper);
    if (answer.contains("u_target"))
      move_.u_target = mvs_of(answer, "u_target", nu_);
    off_.hold(move_.u);
    off_.hold(move_.u_target);
  }

  /// The setpoints; NaN, null in JSON, for a CV without one.
  Eigen::VectorXd setpoints() const { return (options_.setpoint_weight.array() > 0.0).select(y_set_, kNaN); }

  const std::shared_ptr<ControllerTalks> talks_;
  const TransferMatrix G_;
  const MpcOptions options_;
  const QpSolverFactory factory_;
  const Eigen::Index nu_;
  std::string context_;
  std::unique_ptr<RunningProgram> running_;
  Limits soft_;
  SwitchedOff off_;
  Eigen::VectorXd y_set_, acting_;
  ControlMove move_;
  std::string failure_;  ///< empty: none so far
};

}  // namespace

ControllerProgram::ControllerProgram(std::vector<std::string> command, double time_limit)
    : talks_(std::make_shared<ControllerTalks>(std::move(command), time_limit)) {}

const std::vector<std::string>& ControllerProgram::command() const {
  return talks_->command();
}

bool ControllerProgram::runs_on_model() const {
  if (!talks_->on_model())
    try {
      talks_->give_back(talks_->take(""));
    } catch (const ChildFailure& error) {
      throw InputError(fmt::format("{}, description", kControllerPlace), error.what(),
                       fmt::format("an answer within {} s", talks_->time_limit()));
    }
  return *talks_->on_model();
}

std::unique_ptr<Controller> ControllerProgram::controller(const PlantModel& plant, const MpcOptions& options,
                                                          Eigen::Index samples,
                                                          const QpSolverFactory& factory) const {
  return std::make_unique<ProgramController>(talks_, plant, options, samples, factory);
}

bool operator==(const ControllerProgram& a, const ControllerProgram& b) {
  return a.talks_ == b.talks_ ||
         (a.command() == b.command() && a.talks_->time_limit() == b.talks_->time_limit());
}

}  // namespace mpm
