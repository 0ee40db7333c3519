#include <map>
#include <string>

#include <catch2/catch.hpp>

#include "analysis/study_files/study_library.hpp"
#include "bench/perf/qp_sequence.hpp"

namespace mpm {

TEST_CASE("recorded programs are what their names say", "[perf]") {
  const Study study = find_study("chapter6");
  const auto cvs = static_cast<Eigen::Index>(study.plant.cvs.size());
  const auto mvs = static_cast<Eigen::Index>(study.plant.mvs.size());
  const Eigen::Index rows = cvs * study.controller.prediction_horizon;

  std::map<std::string, int> count;
  for (const QpSequence& sequence : recorded_sequences(study)) {
    CAPTURE(sequence.name());
    const QpStructure& structure = *sequence.structure;
    ++count[sequence.problem];
    CHECK(sequence.data.size() == 400);
    if (sequence.problem == "targets") {  // (6.19): the MVs, and a slack a CV
      CHECK(structure.variable_count() == mvs);
      CHECK(structure.slack_count() == cvs);
    } else {  // (6.20): the moves over the control horizon
      CHECK(structure.variable_count() == mvs * study.controller.control_horizon);
      CHECK(structure.row_count() == rows);
      CHECK(structure.slack_count() == (sequence.slack == "per-cv" ? cvs : rows));
    }
  }
  CHECK(count == std::map<std::string, int>{{"moves", 6}, {"targets", 6}});
}

}  // namespace mpm
