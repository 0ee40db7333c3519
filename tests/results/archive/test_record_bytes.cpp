#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/methods/thesis/chain_numbers.hpp"
#include "base/error.hpp"
#include "results/archive/archive.hpp"
#include "results/archive/record_bytes.hpp"
#include "results/files/byte_stream.hpp"
#include "tests/results/made_up_campaign.hpp"

// The one description of a record, and what iterates over it: bytes, differences, archive.

namespace {

using namespace mpm;
using namespace mpm::testing;
using Catch::Contains;
using Names = std::vector<std::string>;

/// Of random experiments with perturbed S0, with bad tunings, of named scenarios, and with faults of all
/// sorts.
std::vector<Campaign> campaigns() {
  return {drawn_campaign(), faultless_campaign(), scenario_campaign(), rich_campaign()};
}

RecordBytes bytes_for(const Campaign& campaign) {
  return {campaign.study, forms_of(campaign)};
}

/// The values of a row of one record as bytes, by the description alone.
std::string bits_of(const RecordRow& row, const ExperimentRecord& record) {
  ByteWriter writer;
  take_values(row, record, [&](const auto& values) {
    for (const auto& value : values)
      transfer(writer, value);
  });
  return writer.take();
}

/// Every variable of every table that has the record, but for those that this use leaves out.
void check_same_variables(const Campaign& campaign, const ExperimentRecord& found,
                          const ExperimentRecord& expected, RowUse left_out) {
  for (const RecordTable& table : record_tables(campaign.study, forms_of(campaign))) {
    const bool present = table.covers(expected);
    REQUIRE(table.covers(found) == present);
    for (const RecordRow& row : table.rows)
      if (present && row.use != left_out && bits_of(row, found) != bits_of(row, expected))
        FAIL_CHECK("experiment " << expected.draw.index << ": '" << table.group << "/" << row.text.name
                                 << "' has changed");
  }
}

TEST_CASE("record tables: every variable comes back out of bytes, bit for bit") {
  for (const Campaign& campaign : campaigns()) {
    const RecordBytes format = bytes_for(campaign);
    for (const ExperimentRecord& record : campaign.records) {
      const std::string bytes = format.to_bytes(record);
      const ExperimentRecord again = format.from_bytes(bytes);
      check_same_variables(campaign, again, record, RowUse::archive_only);
      CHECK(format.differences(again, record) == Names{});
      CHECK(format.to_bytes(again) == bytes);
    }
  }
}

TEST_CASE("record tables: every variable comes back out of an archive, bit for bit") {
  std::vector<Campaign> all = campaigns();
  all.push_back(made_up_campaign());
  for (const Campaign& campaign : all) {
    const TemporaryFolder folder;
    write_archive(folder / "a.h5", campaign, findings_of(campaign));
    const Campaign read = read_archive(folder / "a.h5");
    REQUIRE(read.records.size() == campaign.records.size());
    for (std::size_t i = 0; i < read.records.size(); ++i)
      check_same_variables(campaign, read.records[i], campaign.records[i], RowUse::bytes_only);
  }
}

TEST_CASE("record tables: no two variables of a group have one name") {
  for (const Campaign& campaign : campaigns()) {
    std::set<std::string> names;
    for (const RecordTable& table : record_tables(campaign.study, forms_of(campaign)))
      for (const RecordRow& row : table.rows)
        CHECK(names.insert(table.group + "/" + row.text.name).second);
  }
}

TEST_CASE("record bytes: named scenarios and changed tunings are drawn anew, with all that is in them") {
  const Campaign scenarios = scenario_campaign(), tunings = faultless_campaign();
  for (const Campaign* const campaign : {&scenarios, &tunings})
    for (const ExperimentRecord& record : campaign->records) {
      const RecordBytes format = bytes_for(*campaign);
      const ExperimentDraw draw = format.from_bytes(format.to_bytes(record)).draw;
      CHECK((draw.mismatches == record.draw.mismatches));
      CHECK((draw.disturbances == record.draw.disturbances));
      CHECK(draw.affected_cvs == record.draw.affected_cvs);
      CHECK(draw.named == record.draw.named);
      CHECK(draw.tuning == record.draw.tuning);
      CHECK(draw.noise_factor == record.draw.noise_factor);
    }
}

using Change = std::function<void(ExperimentRecord&)>;

/// A member of a record, a change of it, and the differences that are to name it.
struct MemberChange {
  const char* what;
  Change change;
  Names differences;
};

std::vector<MemberChange> member_changes() {
  const auto solver = [](auto member) { return [member](ExperimentRecord& r) { r.solver.*member += 1; }; };
  const auto loop = [](auto member) {
    return [member](ExperimentRecord& r) { (r.loop->trajectory.*member)(0, 1) += 1.0; };
  };
  const auto loop_solver = [](auto member) {
    return [member](ExperimentRecord& r) { r.loop->trajectory.solver.*member += 1; };
  };
  using A = AssessmentRecord;
  const auto sse = [](auto change) {
    return [change](ExperimentRecord& r) {
      change(*std::find_if(r.assessments.begin(), r.assessments.end(),
                           [](const A& said) { return said.form->method().name == "sse"; }));
    };
  };
  using R = ExperimentRecord;
  using S = SolverStatistics;
  using T = Trajectory;
  return {
      {"parameter", [](R& r) { r.draw.mismatches[0].parameter = MismatchParameter::channel; }, {"parameter"}},
      {"value", [](R& r) { r.draw.mismatches[0].value += 1; }, {"parameter_value"}},
      {"input", [](R& r) { r.draw.mismatches[0].input = 1 - r.draw.mismatches[0].input; }, {"true_mv"}},
      {"gain", [](R& r) { r.draw.disturbances[0].gain += 1; }, {"ud_gain"}},
      {"time constant", [](R& r) { r.draw.disturbances[0].time_constant += 1; }, {"ud_time_constant"}},
      {"message", [](R& r) { r.message += "x"; }, {"message"}},
      {"ivar_basis", [](R& r) { r.ivar_basis(1) = 0.25; }, {"ivar_basis"}},
      {"a zero of another sign", [](R& r) { r.solver.largest_kkt_residual = -0.0; }, {"kkt_residual_max"}},
      {"steps", solver(&S::steps), {"solver_steps"}},
      {"iterations", solver(&S::iterations), {"solver_iterations"}},
      {"fallbacks", solver(&S::fallbacks), {"solver_fallbacks"}},
      {"time", sse([](A& a) { a.milliseconds = 17.0; }), {}},  // differs from run to run
      {"assessment status", sse([](A& a) { a.status = AssessmentStatus::failed; }), {"assessment_status"}},
      {"reason", sse([](A& a) { a.reason += "why"; }), {"methods/sse/reason"}},
      {"flagged", sse([](A& a) { a.flagged = !a.flagged; }), {"flagged"}},
      {"score", sse([](A& a) { a.score = 17.0; }), {"score"}},
      {"predicted_cv", sse([](A& a) { a.predicted_cv = a.predicted_cv == 0 ? 1 : 0; }), {"predicted_cv"}},
      {"source", sse([](A& a) { a.predicted_source = FaultSource::mpm_ud; }), {"predicted_source"}},
      {"a number", sse([](A& a) { a.set_number("cv_score", 17.0, 1); }), {"methods/sse/cv_score"}},
      {"a word", sse([](A& a) { a.set_number("cv_flagged", 1.0, 1); }), {"methods/sse/cv_flagged"}},
      {"the chain", [](R& r) { r.assessments.front().set_number("i_mpm", 17.0); }, {"methods/botelho/i_mpm"}},
      {"time constants",
       [](R& r) { r.perturbed.time_constant(2) = 17.0; },
       {"s0_perturbation/ivar_diag_time_constant"}},
      {"damping", [](R& r) { r.perturbed.damping(0) = 17.0; }, {"s0_perturbation/ivar_diag_damping"}},
      {"no perturbation", [](R& r) { r.perturbed = {}; }, {"s0_perturbation"}},
      {"y", loop(&T::y), {"trajectories/y"}},
      {"u", loop(&T::u), {"trajectories/u"}},
      {"u_target", loop(&T::u_target), {"trajectories/u_target"}},
      {"d", loop(&T::d), {"trajectories/d"}},
      {"y_set", loop(&T::y_set), {"trajectories/y_set"}},
      {"y_sim", [](R& r) { r.loop->y_sim(1, 2) += 1.0; }, {"trajectories/y_sim"}},
      {"samples done", [](R& r) { r.loop->trajectory.samples_done += 1; }, {"trajectories/samples_done"}},
      {"loop status",
       [](R& r) { r.loop->trajectory.status = ControlStatus::failed; },
       {"trajectories/status"}},
      {"failure", [](R& r) { r.loop->trajectory.failure = LoopFailure::plant; }, {"trajectories/failure"}},
      {"what failed", [](R& r) { r.loop->trajectory.message += "x"; }, {"trajectories/message"}},
      {"loop steps", loop_solver(&S::steps), {"trajectories/solver_steps"}},
      {"loop iterations", loop_solver(&S::iterations), {"trajectories/solver_iterations"}},
      {"loop fallbacks", loop_solver(&S::fallbacks), {"trajectories/solver_fallbacks"}},
      {"loop residual",
       [](R& r) { r.loop->trajectory.solver.largest_kkt_residual = 17.0; },
       {"trajectories/kkt_residual_max"}},
      {"no loop", [](R& r) { r.loop.reset(); }, {"trajectories"}},
      {"noise", [](R& r) { r.truth->v(0, 3) += 1.0; }, {"truth/v"}},
      {"disturbance", [](R& r) { r.truth->y_d(1, 0) += 1.0; }, {"truth/y_d"}},
      {"y, mismatch alone", [](R& r) { r.truth->mpm_alone.y(1, 1) += 1.0; }, {"truth_alone/y_mpm_alone"}},
      {"u, mismatch alone", [](R& r) { r.truth->mpm_alone.u(0, 1) += 1.0; }, {"truth_alone/u_mpm_alone"}},
      {"y, disturbance alone", [](R& r) { r.truth->ud_alone.y(1, 1) += 1.0; }, {"truth_alone/y_ud_alone"}},
      {"u, disturbance alone", [](R& r) { r.truth->ud_alone.u(0, 1) += 1.0; }, {"truth_alone/u_ud_alone"}},
      {"no loops alone", [](R& r) { r.truth->mpm_alone = r.truth->ud_alone = {}; }, {"truth_alone"}},
      {"no truth", [](R& r) { r.truth.reset(); }, {"truth", "truth_alone"}},
  };
}

/// An experiment with both faults, a loop, perturbed S0 and an answer of every method, all numbers finite.
ExperimentRecord full_record(const Campaign& campaign) {
  ExperimentRecord record = campaign.records.at(5);
  REQUIRE(record.draw.kind == ExperimentKind::mpm_ud);
  REQUIRE(record.status == ExperimentStatus::ok);
  REQUIRE(record.loop);
  REQUIRE(record.perturbed.damping.size() == 3);
  const Trajectory& loop = record.loop->trajectory;
  record.truth =
      LoopTruth{0.1 * loop.y, 0.2 * loop.y, {0.3 * loop.y, 0.4 * loop.u}, {0.5 * loop.y, 0.6 * loop.u}};
  record.solver.largest_kkt_residual = 0.0;
  record.draw.mismatches[0].value = record.draw.disturbances[0].gain =
      record.draw.disturbances[0].time_constant = 0.5;
  record.loop->trajectory = {ControlStatus::ok,
                             60,
                             Eigen::MatrixXd::Zero(2, 60),
                             Eigen::MatrixXd::Zero(2, 60),
                             Eigen::MatrixXd::Zero(2, 60),
                             Eigen::MatrixXd::Zero(1, 60),
                             Eigen::MatrixXd::Zero(2, 60),
                             {},
                             {}};
  record.loop->y_sim = Eigen::MatrixXd::Zero(2, 60);
  for (AssessmentRecord& said : record.assessments) {
    said = plain_verdict(said.form, false, 0.5);
    said.numbers.setZero();
  }
  return record;
}

TEST_CASE("record bytes: each member that changes is named, and no other") {
  const Campaign campaign = made_up_campaign();
  const RecordBytes format = bytes_for(campaign);
  const ExperimentRecord record = full_record(campaign);
  CHECK(format.differences(record, record) == Names{});
  for (const MemberChange& member : member_changes()) {
    INFO(member.what);
    ExperimentRecord changed = record;
    member.change(changed);
    CHECK(format.differences(record, changed) == member.differences);
    CHECK(format.differences(changed, record) == member.differences);
  }
}

TEST_CASE("record bytes: what follows from others does not come alone") {
  const Campaign campaign = made_up_campaign();
  const RecordBytes format = bytes_for(campaign);
  const ExperimentRecord record = full_record(campaign);
  ExperimentRecord changed = record;
  changed.draw.kind = ExperimentKind::mpm;
  CHECK(format.differences(record, changed) == Names{"kind"});
  changed = record;
  changed.draw.mismatches[0].cv = changed.draw.disturbances[0].cv = 1 - record.draw.true_cv();
  CHECK(format.differences(record, changed) == Names{"true_cv"});
  changed = record;
  changed.status = ExperimentStatus::infeasible;
  CHECK(format.differences(record, changed) == Names{"status"});
}

TEST_CASE("record bytes: a changed tuning is named member by member") {
  const Campaign campaign = faultless_campaign();
  const RecordBytes format = bytes_for(campaign);
  const auto tuned = std::find_if(campaign.records.begin(), campaign.records.end(),
                                  [](const ExperimentRecord& record) { return record.draw.tuning; });
  REQUIRE(tuned != campaign.records.end());
  const auto differences = [&](const std::function<void(TuningChange&)>& change) {
    ExperimentRecord changed = *tuned;
    change(*changed.draw.tuning);
    return format.differences(*tuned, changed);
  };
  CHECK(differences([](TuningChange& t) { t.factor *= 2.0; }) == Names{"tuning_factor"});
  CHECK(differences([](TuningChange& t) { t.index += 1; }) == Names{"tuning_index"});
  CHECK(differences([](TuningChange& t) {
          t.parameter = t.parameter == TuningParameter::slack_weight ? TuningParameter::target_weight
                                                                     : TuningParameter::slack_weight;
        }) == Names{"tuning_parameter"});
}

TEST_CASE("record bytes: cut or lengthened bytes are refused") {
  const Campaign campaign = drawn_campaign();
  const RecordBytes format = bytes_for(campaign);
  ExperimentRecord record = campaign.records[0];
  record.loop.reset();
  const std::string bytes = format.to_bytes(record);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    CHECK_THROWS_AS(format.from_bytes(std::string_view(bytes).substr(0, size)), std::runtime_error);
  CHECK_THROWS_AS(format.from_bytes(bytes + "x"), std::runtime_error);
}

TEST_CASE(
    "record bytes: a table that every record has must be there, and an index must be one of the study") {
  const Campaign campaign = scenario_campaign();
  const RecordBytes format = bytes_for(campaign);
  const std::string bytes = format.to_bytes(campaign.records[0]);
  std::string without = bytes;
  REQUIRE(without[sizeof(std::int64_t)] == 1);  // behind the index: the first table is there
  without[sizeof(std::int64_t)] = 0;
  CHECK_THROWS_WITH(format.from_bytes(without), "a table is missing that every record has");
  ExperimentRecord record = campaign.records[0];
  for (const std::int64_t index : std::vector<std::int64_t>{-1, campaign.study.experiment_count()}) {
    record.draw.index = index;
    CHECK_THROWS_AS(format.from_bytes(format.to_bytes(record)), InputError);
  }
}

TEST_CASE("record bytes: a flag that is none of its values is refused by name") {
  const Campaign campaign = drawn_campaign();
  const RecordBytes format = bytes_for(campaign);
  const ExperimentRecord& record = campaign.records[0];
  REQUIRE(record.status == ExperimentStatus::ok);
  const auto refusal = [&](const Change& change) -> std::string {
    ExperimentRecord changed = record;
    change(changed);
    try {
      format.from_bytes(format.to_bytes(changed));
      return "accepted";
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  };
  CHECK(refusal([](ExperimentRecord& r) { r.status = static_cast<ExperimentStatus>(4); }) ==
        "status is 4, which is none of its values");
  CHECK(refusal([](ExperimentRecord& r) { r.assessments[1].status = static_cast<AssessmentStatus>(-1); }) ==
        "assessment_status is -1, which is none of its values");
  CHECK(refusal([](ExperimentRecord& r) { r.assessments[0].predicted_cv = 2; }) ==
        "predicted_cv is 2, which is none of its values");
  CHECK(refusal([](ExperimentRecord& r) {
          r.assessments[0].predicted_source = static_cast<FaultSource>(9);
        }) == "predicted_source is 9, which is none of its values");
  CHECK(refusal([](ExperimentRecord& r) { r.assessments[0].set_number("cv_source", 5.0); }) ==
        "cv_source is 5, which is none of its values");
}

}  // namespace
