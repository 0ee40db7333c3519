// [plant]: a plant of the catalogue, or one that the file defines.

#include <algorithm>
#include <iterator>
#include <memory>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "analysis/study_files/study_file_parts.hpp"
#include "analysis/study_files/transfer_function_keys.hpp"
#include "plants/models/catalogue.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

constexpr std::size_t kMaxVariables = 200;  // far above any plant of the literature

OptionKeys variable_keys(PlantModel::Variable& variable) {
  return {key::name("name", variable.name, "name of the variable in the other tables and in results")
              .also("no two variables alike"),
          key::text("unit", variable.unit, "unit").required().allow("not empty; `\"1\"` for none"),
          key::text("description", variable.description, "what it is").otherwise("empty")};
}

/// A channel from an MV or MD to a CV.
struct ChannelEntry {
  Eigen::Index cv, input;
};

OptionKeys channel_keys(ChannelEntry& channel, const PlantModel& model) {
  OptionKeys keys{key::one_of(
                      "cv", channel.cv, [&] { return variable_names(model.cvs); }, "output of the channel")
                      .allow("name of a CV"),
                  key::one_of(
                      "input", channel.input, [&] { return input_names(model); },
                      "input of the channel; each channel is listed at most once")
                      .allow("name of an MV or MD")};
  for (OptionKey& key : transfer_function_keys("input", "poles with negative real parts; one pole may be 0"))
    keys.push_back(std::move(key));
  return keys;
}

OptionKeys own_plant_keys(PlantModel& model) {
  const auto variables = [&model](const char* name, std::vector<PlantModel::Variable>& group,
                                  const char* meaning) {
    return key::list<PlantModel::Variable>(
               name, kMaxVariables, variable_keys,
               [&model, &group](const TomlTable& table, PlantModel::Variable& variable) {
                 for (const auto* known : {&model.cvs, &model.mvs, &model.mds})
                   for (const PlantModel::Variable& other : *known)
                     if (other.name == variable.name)
                       table.refuse("name", fmt::format("'{}' for a second variable", variable.name),
                                    "every name once");
                 group.push_back(variable);
               },
               meaning)
        .allow("1 to 200");
  };
  const auto sized = [&model] {
    model.G = TransferMatrix(static_cast<Eigen::Index>(model.cvs.size()),
                             static_cast<Eigen::Index>(model.mvs.size() + model.mds.size()));
  };
  const auto take = [&model, listed = std::make_shared<std::set<std::pair<Eigen::Index, Eigen::Index>>>()](
                        const TomlTable& table, ChannelEntry& at) {
    const auto [channel, step_error] = read_transfer_function(table);
    refuse_unstable(table, channel, PolesAtOrigin::one);
    if (!listed->emplace(at.cv, at.input).second)
      table.refuse("", "a second channel from this input to this CV", "every channel once");
    model.G(at.cv, at.input) = channel;
    if (table.has("step"))
      model.step_fits.push_back({at.cv, at.input, step_error});
  };
  return {
      key::name("name", model.name, "short name"),
      key::text("title", model.title, "title in one line").required(),
      key::text("time_unit", model.time_unit, "unit of all times in the study, such as `\"min\"`").required(),
      variables("cv", model.cvs, "controlled variables, in the order of the rows of `G0`").required(),
      variables("mv", model.mvs, "manipulated variables, in the order of the columns").required(),
      variables("md", model.mds, "measured disturbances, in the order of the columns after those of the MVs"),
      key::check([sized](const TomlTable&) { sized(); }),
      key::list<ChannelEntry>(
          "channel", kMaxVariables * kMaxVariables,
          [&model](ChannelEntry& at) { return channel_keys(at, model); }, take,
          "channels of `G0`; those not listed are zero")
          .allow("one or more")
          .required()};
}

/// Refuses a plant without a channel from an MV to a CV, because a mismatch changes such a channel.
void refuse_without_mv_channel(const TomlTable& plant, const PlantModel& model) {
  for (Eigen::Index row = 0; row < model.G.rows(); ++row)
    for (std::size_t mv = 0; mv < model.mvs.size(); ++mv)
      if (!model.G(row, static_cast<Eigen::Index>(mv)).is_zero())
        return;
  plant.refuse("channel", "no channel from an MV that is not zero", "at least one");
}

PlantModel read_plant(const TomlTable& plant) {
  PlantModel model;
  if (!plant.has("catalogue")) {
    read_keys(plant, own_plant_keys(model));
    refuse_without_mv_channel(plant, model);
    plant.located("", [&] { return model.validate(); });
    return model;
  }
  for (const std::string& key : key_names(own_plant_keys(model)))
    if (plant.has(key))
      plant.refuse(key, "a key beside catalogue", "catalogue alone, or an own plant without it");
  const std::vector<std::string> names = benchmark_plant_names();
  return benchmark_plant(names[read_one_of(plant, "catalogue", names)]);
}

OptionKeys plant_keys() {
  PlantModel model;
  OptionKeys keys{key::option("catalogue", "text", "a plant that comes with the program")
                      .otherwise("none")
                      .allow("a name of [the catalogue](plants.md)")};
  for (const OptionKeys& part : {simulated_keys(), described(own_plant_keys(model)), foreign_keys()})
    keys.insert(keys.end(), part.begin(), part.end());
  return keys;
}

}  // namespace

OptionKey plant_key(Study& study, const std::filesystem::path& folder) {
  return key::option("plant", "table", "the nominal model `G0`")
      .required()
      .with("", plant_keys)
      .read([&study, folder](const TomlTable& document, const std::string& key) {
        const TomlTable plant = document.table(key, key_names(plant_keys()));
        study.plant = read_plant(plant);
        study.nonlinear = read_nonlinear_simulation(plant, study.plant, folder);
      });
}

}  // namespace mpm
