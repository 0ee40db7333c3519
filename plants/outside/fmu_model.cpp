#include "plants/outside/fmu_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/system/fork_server.hpp"
#include "base/system/program_trust.hpp"
#include "plants/outside/fmu_instance.hpp"
#include "plants/outside/fmu_package.hpp"

namespace mpm {
namespace {

/// An unpacked FMU, what the study uses of it, and the server that makes the processes of its loops.
struct LoadedFmu {
  explicit LoadedFmu(const std::filesystem::path& file) : package(file) {}

  FmuPackage package;
  FmuReferences references;
  std::vector<bool> tunable;  ///< for each parameter
  std::optional<ForkServer> server;
};

/// The kind of a request to the process that has the instance: the first number of the request.
enum class FmuRequest { start, change, step };

std::vector<double> request_of(FmuRequest kind, const Eigen::VectorXd& first,
                               const Eigen::VectorXd& second = {}) {
  std::vector<double> request{static_cast<double>(kind)};
  request.insert(request.end(), first.begin(), first.end());
  request.insert(request.end(), second.begin(), second.end());
  return request;
}

/// The other end: answers requests in the process that has the instance.
class FmuServer {
 public:
  FmuServer(const LoadedFmu& fmu, FmuSteps steps) : fmu_(fmu), steps_(steps) {}

  std::vector<double> serve(const std::vector<double>& request) {
    const Eigen::Map<const Eigen::VectorXd> all(request.data(), static_cast<Eigen::Index>(request.size()));
    const auto parameters = static_cast<Eigen::Index>(fmu_.references.parameters.size());
    const Eigen::VectorXd numbers = all.tail(all.size() - 1);
    switch (static_cast<FmuRequest>(static_cast<int>(request.front()))) {
      case FmuRequest::start:
        instance_.emplace(fmu_.package, fmu_.references, numbers.head(parameters),
                          numbers.tail(numbers.size() - parameters), steps_);
        break;
      case FmuRequest::change:
        instance_->set_parameters(numbers);
        break;
      case FmuRequest::step: {
        const Eigen::VectorXd y = instance_->step(numbers);
        return {y.begin(), y.end()};
      }
    }
    return {};
  }

 private:
  const LoadedFmu& fmu_;
  FmuSteps steps_;
  std::optional<FmuInstance> instance_;
};

class FmuSimulation final : public ForeignSimulation {
 public:
  FmuSimulation(std::shared_ptr<const LoadedFmu> fmu, FmuSteps steps, double time_limit)
      : fmu_(std::move(fmu)), steps_(steps), time_limit_(time_limit) {}

  void start(const Eigen::VectorXd& parameters, const Eigen::VectorXd& input) override {
    service_.emplace(*fmu_->server, std::vector{steps_.length, static_cast<double>(steps_.count)},
                     time_limit_);
    service_->ask(request_of(FmuRequest::start, parameters, input));
  }
  void change(const Eigen::VectorXd& parameters) override {
    service_->ask(request_of(FmuRequest::change, parameters));
  }
  Eigen::VectorXd step(const Eigen::VectorXd& input) override {
    const std::vector<double> y = service_->ask(request_of(FmuRequest::step, input));
    if (y.size() != fmu_->references.outputs.size() ||
        !std::all_of(y.begin(), y.end(), [](double each) { return std::isfinite(each); }))
      throw ForeignFailure("an answer that is not of its interface");
    return Eigen::Map<const Eigen::VectorXd>(y.data(), static_cast<Eigen::Index>(y.size()));
  }

 private:
  std::shared_ptr<const LoadedFmu> fmu_;
  FmuSteps steps_;
  double time_limit_;
  std::optional<ServedProcess> service_;
};

class FmuModel final : public ForeignModel {
 public:
  FmuModel(FmuSettings settings, const ForeignOptions& options)
      : ForeignModel(options), settings_(std::move(settings)) {}

  std::string description() const override {
    std::string text =
        fmt::format("{} {} {} {} {}", settings_.file.filename().string(), settings_.time_factor,
                    options().settle, options().settle_tolerance, options().time_limit);
    if (settings_.step > 0.0)
      text += fmt::format(" steps of {}", settings_.step);
    for (const auto* list : {&settings_.inputs, &settings_.outputs, &settings_.parameters})
      for (const FmuSettings::Variable& variable : *list)
        text += fmt::format(" '{}'", variable.name);
    return text;
  }

  void load() const override {
    const std::lock_guard lock(mutex_);
    if (loaded_)
      return;
    require_trusted_fmu(settings_.file);
    std::error_code no_status;
    if (!std::filesystem::is_regular_file(settings_.file, no_status))
      throw InputError(
          settings_.place, fmt::format("'{}', which is no file", settings_.file.string()),
          "an FMU; its path is taken from the folder of the study file, for a study of an archive "
          "from the current one");
    auto fmu = std::make_shared<LoadedFmu>(settings_.file);
    fmu->references = {references_of(fmu->package, settings_.inputs, FmuRole::input),
                       references_of(fmu->package, settings_.outputs, FmuRole::output),
                       references_of(fmu->package, settings_.parameters, FmuRole::parameter)};
    for (const FmuSettings::Variable& each : settings_.parameters)
      fmu->tunable.push_back(fmu->package.description().variables.at(each.name).variability == "tunable");
    fmu->server.emplace([&loaded = *fmu](const std::vector<double>& setting) {
      const auto server =
          std::make_shared<FmuServer>(loaded, FmuSteps{setting[0], static_cast<int>(setting[1])});
      return [server](const std::vector<double>& request) { return server->serve(request); };
    });
    loaded_ = std::move(fmu);
  }

  std::filesystem::path file() const override { return settings_.file; }
  Eigen::Index output_count() const override { return static_cast<Eigen::Index>(settings_.outputs.size()); }
  bool is_tunable(std::size_t parameter) const override { return loaded_->tunable[parameter]; }

  std::unique_ptr<ForeignSimulation> simulation(double sample_time) const override {
    return std::make_unique<FmuSimulation>(
        loaded_, FmuSteps::of_sample(sample_time * settings_.time_factor, settings_.step),
        options().time_limit);
  }

 private:
  static std::vector<fmi2::ValueReference> references_of(const FmuPackage& package,
                                                         const std::vector<FmuSettings::Variable>& variables,
                                                         FmuRole role) {
    std::vector<fmi2::ValueReference> references;
    for (const FmuSettings::Variable& each : variables)
      references.push_back(package.description().variable(each.name, role, each.place).reference);
    return references;
  }

  FmuSettings settings_;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const LoadedFmu> loaded_;
};

}  // namespace

std::shared_ptr<const ForeignModel> fmu_model(FmuSettings settings, const ForeignOptions& options) {
  return std::make_shared<const FmuModel>(std::move(settings), options);
}

}  // namespace mpm
