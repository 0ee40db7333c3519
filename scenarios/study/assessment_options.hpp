#pragma once

#include <any>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <typeindex>
#include <vector>

#include "base/enum_words.hpp"

// The open choices of the methods that assess a controller ([assessment] of a study file). Only the method
// itself knows its options: a study holds them as values whose types it does not know.

namespace mpm {

class MethodTable;
struct OptionKey;

/// The options of the methods, one value a method, found by its type.
class MethodOptions {
 public:
  /// The options of this type; the defaults if nothing was read or set.
  template <class Options>
  const Options& of() const {
    static const Options defaults;
    const auto found = values_.find(typeid(Options));
    return found == values_.end() ? defaults : *std::any_cast<Options>(&found->second.value);
  }
  /// The same, to be read into or set. The reference remains valid.
  template <class Options>
  Options& of() {
    const auto [place, is_new] = values_.try_emplace(typeid(Options));
    if (is_new)
      place->second = {Options{}, [](const std::any& a, const std::any& b) {
                         return *std::any_cast<Options>(&a) == *std::any_cast<Options>(&b);
                       }};
    return *std::any_cast<Options>(&place->second.value);
  }

  bool operator==(const MethodOptions&) const = default;

 private:
  struct Value {
    std::any value;
    bool (*equal)(const std::any& a, const std::any& b) = nullptr;

    bool operator==(const Value& other) const { return equal(value, other.value); }
  };
  std::map<std::type_index, Value> values_;
};

/// The table [assessment.NAME] of a method.
struct MethodOptionTable {
  std::string meaning;                                                 ///< for the manual
  std::function<std::vector<OptionKey>(MethodOptions& options)> keys;  ///< tied to the options of the method
  std::string name = {};
};

/// What takes the place of a setpoint for a CV that the controller holds in a range.
enum class AssessmentSetpoints : std::int8_t {
  controller = 0,  ///< nothing: a method that needs setpoints does not apply
  optimizer = 1,   ///< the steady state that the target optimizer computes (2.32), as chapter 2 does it
};

/// What the methods assume of the plant without a fault.
enum class AssessmentModel : std::int8_t {
  automatic = 0,  ///< benchmark if the model is not exact, otherwise nominal (model_assumption())
  nominal = 1,    ///< the plant is exactly the model of the controller
  benchmark = 2,  ///< the model may be off by some percent; the benchmark says by how much
};

template <>
inline constexpr auto kWords<AssessmentModel> = word_list("automatic", "nominal", "benchmark");

/// [assessment]
struct AssessmentOptions : MethodOptions {
  AssessmentSetpoints setpoints = AssessmentSetpoints::controller;
  AssessmentModel model = AssessmentModel::automatic;
  double model_error =
      0.05;           ///< relative standard deviation of gain, time constant and dead time of a channel
  double bias = 0.5;  ///< standard deviation of a constant error of a CV, in those of its noise
  double washout =
      0;  ///< time constant for CVs that integrate, time unit of the plant; 0: the prediction horizon
  /// The methods that the study may name (method_table()); none: those of this program.
  std::shared_ptr<const MethodTable> table = {};

  bool operator==(const AssessmentOptions&) const = default;
};

}  // namespace mpm
