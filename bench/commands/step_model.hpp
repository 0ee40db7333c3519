#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plants/linear/plant_model.hpp"
#include "plants/linear/step_response_fit.hpp"

namespace mpm {

/// A model in the form of dynamic matrix control: coefficients of step responses.
struct StepModel {
  struct Channel {
    std::string cv, input;
    StepResponseFit fit;
    TransferFunction function;  ///< the fit, or the coefficients if its error is not negligible
    bool exact = false;         ///< the fit gives the coefficients in all of their digits
  };

  std::string file;
  double interval = 0.0;          ///< between two coefficients
  std::vector<Channel> channels;  ///< in the order of the columns

  std::vector<std::string> cvs() const;
  /// The inputs except these, in the order of the columns.
  std::vector<std::string> inputs_but(const std::vector<std::string>& mds) const;
  /// Puts the channels into the plant where it has none. Errors: InputError for a variable that the plant
  /// does not have.
  void put_into(PlantModel& plant) const;
  /// Each fit and its error, one line per channel.
  std::string report() const;
};

/// Reads a file with columns CV/INPUT, which have the coefficients of the response to a step of 1. The time
/// between two coefficients is `interval`, or comes from a column `time`; a first row at time 0 is left out.
/// Errors: InputError, which names the file and the column.
StepModel read_step_model(const std::string& file, std::optional<double> interval);

}  // namespace mpm
