#include "scenarios/controller/model_json.hpp"

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "plants/linear/linear_plant.hpp"

namespace mpm {
namespace {

using Json = nlohmann::ordered_json;

Json row_json(const Eigen::Ref<const Eigen::RowVectorXd, 0, Eigen::InnerStride<>>& row) {
  Json::array_t list;
  list.reserve(static_cast<std::size_t>(row.size()));
  for (const double value : row)
    list.emplace_back(value);
  return list;
}

Json variables_json(const std::vector<PlantModel::Variable>& variables) {
  Json list = Json::array();
  for (const PlantModel::Variable& variable : variables)
    list.push_back({{"name", variable.name}, {"unit", variable.unit}});
  return list;
}

Json model_json(const PlantModel& plant, double sample_time, Eigen::Index samples) {
  const TransferMatrix& G = plant.G;
  const std::vector<std::string> inputs = input_names(plant);
  Json channels = Json::array();
  for (Eigen::Index cv = 0; cv < G.rows(); ++cv)
    for (Eigen::Index input = 0; input < G.cols(); ++input)
      if (const TransferFunction& channel = G(cv, input); !channel.is_zero())
        channels.push_back({{"cv", plant.cvs[static_cast<std::size_t>(cv)].name},
                            {"input", inputs[static_cast<std::size_t>(input)]},
                            {"numerator", vector_json(channel.numerator())},
                            {"denominator", vector_json(channel.denominator())},
                            {"dead_time", channel.dead_time()}});
  Json steps = Json::array();
  for (const Eigen::MatrixXd& response : step_response(G, sample_time, samples))
    steps.push_back(matrix_json(response));
  return {{"inputs", inputs}, {"transfer_functions", channels}, {"step_responses", steps}};
}

Json analyser_json(const std::vector<AnalyserTiming>& timings, int AnalyserTiming::*member) {
  Json numbers = Json::array();
  for (const AnalyserTiming& timing : timings)
    numbers.push_back(timing.*member);
  return numbers;
}

Json controller_json(const MpcOptions& controller) {
  return {{"prediction_horizon", controller.prediction_horizon},
          {"control_horizon", controller.control_horizon},
          {"weight_convention", to_string(controller.weight_convention)},
          {"move_suppression", vector_json(controller.move_suppression)},
          {"target_weight", vector_json(controller.target_weight)},
          {"setpoint_weight", vector_json(controller.setpoint_weight)},
          {"slack_weight", vector_json(controller.slack_weight)},
          {"slack_cost", vector_json(controller.slack_cost)},
          {"reference_time", vector_json(controller.reference_time)},
          {"bias_ramp", vector_json(controller.bias_ramp)},
          {"analyser_period", analyser_json(controller.analysers, &AnalyserTiming::period)},
          {"analyser_delay", analyser_json(controller.analysers, &AnalyserTiming::delay)},
          {"md_analyser_period", analyser_json(controller.md_analysers, &AnalyserTiming::period)},
          {"md_analyser_delay", analyser_json(controller.md_analysers, &AnalyserTiming::delay)},
          {"move_starts", controller.move_starts()},
          {"move_limit", vector_json(controller.move_limit)},
          {"resting_value", vector_json(controller.resting_value)},
          {"resting_weight", vector_json(controller.resting_weight)},
          {"mv_cost", vector_json(controller.mv_cost)},
          {"mv_hard", limits_json(controller.mv_hard)},
          {"cv_hard", limits_json(controller.cv_hard)},
          {"cv_soft", limits_json(controller.cv_soft)}};
}

}  // namespace

Json vector_json(const Eigen::VectorXd& vector) {
  return row_json(vector.transpose());
}

Json matrix_json(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    rows.push_back(row_json(matrix.row(i)));
  return rows;
}

Json limits_json(const Limits& limits) {
  return {{"lower", vector_json(limits.lower)}, {"upper", vector_json(limits.upper)}};
}

Json loop_context_json(const PlantModel& plant, const MpcOptions& controller, Eigen::Index samples) {
  return {{"plant", plant.name},
          {"time_unit", plant.time_unit},
          {"sample_time", controller.sample_time},
          {"cvs", variables_json(plant.cvs)},
          {"mvs", variables_json(plant.mvs)},
          {"mds", variables_json(plant.mds)},
          {"model", model_json(plant, controller.sample_time, samples)},
          {"controller", controller_json(controller)}};
}

}  // namespace mpm
