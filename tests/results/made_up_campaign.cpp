#include "tests/results/made_up_campaign.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "analysis/methods/method_table.hpp"
#include "scenarios/random_stream.hpp"
#include "scenarios/study_file.hpp"

namespace mpm::testing {
namespace {

std::string small_study() {
  return file_content(MPMBENCH_SOURCE_DIR "/tests/scenarios/data/small.toml");
}

constexpr const char* kS0Perturbation =
    "\n[s0_perturbation]\nmultipliers = [0.5, 1, 2]\nfixed_mvs = ['hot']\nfixed_active_cvs = ['level']\n";

/// Numbers, one in eight of them an awkward one.
class Numbers {
 public:
  double next() {
    switch (stream_.below(40)) {
      case 0:
        return std::bit_cast<double>(std::uint64_t{0x7FF8000000ABCDEF});  // a NaN with a payload
      case 1:
        return std::numeric_limits<double>::infinity();
      case 2:
        return -std::numeric_limits<double>::infinity();
      case 3:
        return -0.0;
      case 4:
        return std::numeric_limits<double>::denorm_min();
      default:
        return stream_.uniform() * 3.0;
    }
  }
  Eigen::VectorXd vector(Eigen::Index size) {
    return Eigen::VectorXd::NullaryExpr(size, [this](Eigen::Index) { return next(); });
  }
  Eigen::MatrixXd matrix(Eigen::Index rows, Eigen::Index cols) {
    return Eigen::MatrixXd::NullaryExpr(rows, cols, [this](Eigen::Index, Eigen::Index) { return next(); });
  }
  std::int64_t whole() { return static_cast<std::int64_t>(stream_.below(std::uint64_t{1} << 40)); }
  int index(Eigen::Index size) { return static_cast<int>(stream_.below(static_cast<std::uint64_t>(size))); }

 private:
  RandomStream stream_{2, 3, StreamId::measurement_noise};
};

SolverStatistics solver(Numbers& numbers) {
  return {numbers.whole(), numbers.whole(), numbers.whole(), numbers.next()};
}

MpmIndicator indicator(Numbers& numbers) {
  return {numbers.next(), numbers.next(),     numbers.next(),    numbers.next(),
          numbers.next(), numbers.index(100), numbers.index(100)};
}

/// Any numbers for columns of quantities, any of the words for verdicts.
template <class Owner>
void fill(Numbers& numbers, Owner& owner, const std::vector<NumberColumn<Owner>>& columns) {
  for (const NumberColumn<Owner>& column : columns)
    column.set(owner,
               column.words.empty()
                   ? numbers.next()
                   : static_cast<double>(numbers.index(static_cast<Eigen::Index>(column.words.size()))));
}

DistributionIndicators distribution(Numbers& numbers) {
  DistributionIndicators made;
  made.mpm = indicator(numbers);
  fill(numbers, made, distribution_columns());
  fill(numbers, made, scatter_columns());
  return made;
}

AcfComparison acf(Numbers& numbers, Eigen::Index samples) {
  AcfComparison made;
  fill(numbers, made, acf_columns());
  for (AcfFeatures* features : {&made.y, &made.y0, &made.y0_diag})
    features->values = numbers.vector(samples / 4 + 1);
  return made;
}

Diagnosis diagnosis(Numbers& numbers, Eigen::Index ny) {
  Diagnosis made;
  made.ivar = numbers.vector(ny);
  made.ivar_diag = numbers.vector(ny);
  made.ivar_basis = numbers.vector(ny);
  made.impactful = numbers.index(2) == 1;
  made.predicted_cv = numbers.index(ny);
  made.predicted_source = numbers.index(2) == 1 ? ExperimentKind::mpm : ExperimentKind::ud;
  made.indicator = indicator(numbers);
  return made;
}

/// The small study with a setpoint beside the range of its first CV.
std::string with_setpoint(std::string text) {
  const std::string weight = "slack_weight = 8";
  return text.insert(text.find(weight), "setpoint_weight = 5\n");
}

Trajectory trajectory(Numbers& numbers, const Study& study, ControlStatus status) {
  const Eigen::Index samples = study.simulation.samples;
  return {status,
          numbers.index(samples),
          numbers.matrix(study.cv_count(), samples),
          numbers.matrix(study.mv_count(), samples),
          numbers.matrix(study.mv_count(), samples),
          numbers.matrix(study.md_count(), samples),
          study.controller.has_setpoints() ? numbers.matrix(study.cv_count(), samples) : Eigen::MatrixXd(),
          solver(numbers)};
}

Mismatch made_up_mismatch(Numbers& numbers, const Study& study, Eigen::Index cv) {
  Mismatch made{cv, numbers.index(study.mv_count()), MismatchParameter::gain, 0.0};
  made.parameter = static_cast<MismatchParameter>(numbers.index(3));
  made.value = numbers.next();
  return made;
}

Disturbance made_up_disturbance(Numbers& numbers, Eigen::Index cv) {
  Disturbance made{cv, numbers.next(), 0.0};
  made.time_constant = numbers.next();
  return made;
}

ExperimentRecord record(Numbers& numbers, const Study& study, std::int64_t index) {
  ExperimentRecord made;
  made.draw.index = index;
  made.draw.kind = static_cast<ExperimentKind>(1 + index % 3);
  const Eigen::Index cv = numbers.index(study.cv_count());
  if (made.draw.kind != ExperimentKind::ud)
    made.draw.mismatches = {made_up_mismatch(numbers, study, cv)};
  if (made.draw.kind != ExperimentKind::mpm)
    made.draw.disturbances = {made_up_disturbance(numbers, cv)};
  made.status = static_cast<ExperimentStatus>(index % 5 == 3 ? 1 : index % 7 == 4 ? 2 : 0);
  if (made.status == ExperimentStatus::ok)
    made.diagnosis = diagnosis(numbers, study.cv_count());
  if (made.status == ExperimentStatus::failed)
    made.message = "died: \xC3\xBC \xE6\xB8\xAC";
  if (made.status == ExperimentStatus::ok && index % 4 == 1)
    made.perturbed = {numbers.vector(3), numbers.vector(3)};
  made.ivar_diag_mpm_alone = numbers.next();
  made.ivar_diag_ud_alone = numbers.next();
  made.dominance_mpm = numbers.next();
  made.solver = solver(numbers);
  if (index % 2 == 1)
    made.loop = {
        trajectory(numbers, study,
                   made.status == ExperimentStatus::ok ? ControlStatus::ok : ControlStatus::infeasible),
        numbers.matrix(study.cv_count(), study.simulation.samples)};
  return made;
}

AuditDifference difference(Numbers& numbers) {
  return {numbers.index(2) == 1, numbers.next(), numbers.next()};
}

BasisCase basis_case(Numbers& numbers, const Study& study, const std::vector<ActiveReference>& active) {
  const Eigen::Index ny = study.cv_count();
  const Eigen::Index samples = study.simulation.samples;
  BasisCase made;
  made.point = {numbers.vector(study.mv_count()), numbers.vector(ny), active, {}};
  made.sensitivity = {ny, active, {}};
  for (std::size_t a = 0; a < active.size(); ++a)
    made.sensitivity.step_response.push_back(numbers.matrix(ny, 17));
  if (!active.empty())
    made.point.fixed_mvs.push_back(1);
  made.trajectory = trajectory(numbers, study, ControlStatus::ok);
  made.nominal = {numbers.matrix(ny, samples), numbers.matrix(ny, samples), numbers.matrix(ny, samples)};
  made.diagnosis = diagnosis(numbers, ny);
  made.healthy = true;
  made.explanation = "fine";
  return made;
}

/// `ordinary`: with a verdict and a finite score.
MethodVerdict verdict(Numbers& numbers, const Study& study, bool ordinary) {
  MethodVerdict made;
  made.seconds = numbers.next();
  made.status = static_cast<AssessmentStatus>(ordinary ? 0 : std::max(0, numbers.index(6) - 3));  // mostly ok
  if (made.status != AssessmentStatus::ok)
    return made;
  made.flagged = numbers.index(2) == 1;
  made.score = ordinary ? 0.001 * numbers.index(1000) : numbers.next();
  made.located_cv = numbers.index(study.cv_count() + 1) - 1;
  made.source = static_cast<ExperimentKind>(numbers.index(3));
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
    if (numbers.index(2) == 1)
      made.flagged_channels.push_back({cv, numbers.index(study.mv_count())});
  return made;
}

/// In place of the counts of the small study.
constexpr const char* kScenarios = R"(
[[scenario]]
name = "healthy"
[[scenario]]
name = "channels"
description = "<b> 'all' & more"
mismatch = [{cv = "level", input = "hot", gain_factor = 1.5, dead_time_shift = -1},
            {cv = "level", input = "drain", time_constant_factor = 2},
            {cv = "heat", input = "hot", numerator = [2, 1], denominator = [30, 12, 1], dead_time = 4}]
[[scenario]]
name = "signals"
affected = ["heat"]
disturbance = [{cv = "level", gain = 0.5, time_constant = 6},
               {cv = "level", white = 2, hold = 3},
               {cv = "heat", sine = {amplitude = 0.2, period = 30}},
               {cv = "heat", ramp = {slope = 0.01, start = 7}, numerator = [0.3, 2], denominator = [100, 30, 0]},
               {cv = "heat", steps = [{sample = 3, level = 1}, {sample = 9, level = -1}], gain = 1, time_constant = 8}]
[[scenario]]
name = "infeasible"
affected = []
mismatch = [{cv = "heat", input = "cold", gain_factor = 9}]
disturbance = [{cv = "heat", white = 5}]
[[scenario]]
name = "failed"
mismatch = [{cv = "heat", input = "cold", gain_factor = 0.1}]
)";

}  // namespace

Campaign made_up_campaign() {
  Numbers numbers;
  Campaign campaign;
  campaign.study = parse_study(
      with_setpoint(small_study()) + "\n[aggregate]\nbootstrap_replications = 200\n" + kS0Perturbation,
      "small");
  campaign.study.seed = 18446744073709551615U;  // not the one in the text, and above the signed range
  campaign.info = {"1.2.3", "abc+", "2015-04-01T12:00:00Z", "mpmbench run \xC3\xBC.toml", "ipopt", 0.1, 3,
                   0.25,    0.7};
  campaign.basis =
      basis_case(numbers, campaign.study, {{1, ReferenceKind::upper_limit}, {0, ReferenceKind::setpoint}});
  campaign.basis.sensitivity_fixed =
      NominalSensitivity{2, {{0, ReferenceKind::lower_limit}}, {numbers.matrix(2, 17)}};
  for (std::int64_t index = 0; index < 40; ++index)
    campaign.records.push_back(record(numbers, campaign.study, index));
  for (std::int64_t step = 0; step < 5; ++step)
    campaign.audit.push_back(
        {numbers.whole(), step, difference(numbers), difference(numbers), numbers.next()});
  campaign.comparison = made_up_comparison(campaign.study, campaign.records);
  campaign.comparison_info = {"1.3.0", "def", "mpmbench compare \xC3\xBC.h5"};
  return campaign;
}

Comparison made_up_comparison(const Study& study, const std::vector<ExperimentRecord>& records) {
  Numbers numbers;
  Comparison made;
  made.methods = assessment_method_names();
  for (const ExperimentRecord& record : records) {
    if (record.status != ExperimentStatus::ok)
      continue;
    made.loops.push_back({record.draw.index, {}});
    for (std::size_t method = 0; method < made.methods.size(); ++method)
      made.loops.back().verdicts.push_back(verdict(numbers, study, method == 0));
  }
  for (std::size_t method = 0; method < made.methods.size(); ++method)
    made.reasons.push_back(method % 2 == 0 ? "" : "no \xC3\xBC");
  return made;
}

Campaign faultless_campaign() {
  Numbers numbers;
  std::string text = with_setpoint(small_study());
  const std::string last_count = "mpm_ud = 1\n";
  text.replace(text.find(last_count), last_count.size(), "mpm_ud = 0\nhealthy = 3\ntuning = 8\n");
  Campaign campaign;
  campaign.study = parse_study(text + "\n[aggregate]\nbootstrap_replications = 200\n", "small");
  campaign.info = {"1.2.3", "abc", "2015-04-01T12:00:00Z", "mpmbench run x.toml", "ipopt", 0.1, 3, 0.0, 0.0};
  campaign.basis = basis_case(numbers, campaign.study, {{1, ReferenceKind::upper_limit}});
  for (std::int64_t index = 0; index < 48; ++index) {
    ExperimentRecord made = record(numbers, campaign.study, index);
    made.draw = draw_experiment(campaign.study, index);
    made.perturbed = {};
    campaign.records.push_back(std::move(made));
  }
  return campaign;
}

Campaign empty_campaign() {
  Numbers numbers;
  std::string text = small_study();
  const auto remove = [&text](const std::string& from, const std::string& to) {
    const std::size_t begin = text.find(from);
    const std::size_t end = text.find(to, begin);
    if (begin == std::string::npos || end == std::string::npos)
      throw std::logic_error("the small study has no " + from + " before a " + to);
    text.erase(begin, end - begin);
  };
  remove("[[plant.md]]", "[[plant.channel]]");
  remove("[[plant.channel]]\ncv = \"level\"\ninput = \"drain\"", "[controller]");
  remove("[[simulation.step]]", "[experiments]");
  Campaign campaign;
  campaign.study = parse_study(text, "small");
  campaign.basis = basis_case(numbers, campaign.study, {});
  return campaign;
}

Campaign scenario_campaign() {
  Numbers numbers;
  std::string text = small_study();
  text.erase(text.find("[experiments]"));
  Campaign campaign;
  campaign.study = parse_study(text + "[sensitivity]\nform = 'box-jenkins'\n" + kScenarios, "small");
  campaign.info = {"1.2.3", "abc", "2015-04-01T12:00:00Z", "mpmbench run x.toml", "ipopt", 0.1, 3, 0.0, 0.0};
  campaign.basis = basis_case(numbers, campaign.study, {{1, ReferenceKind::upper_limit}});
  campaign.basis.sensitivity_direct = campaign.basis.sensitivity;
  campaign.basis.sensitivity_direct->step_response[0](1, 2) += 0.5;
  for (int cv = 0; cv < 2; ++cv)
    campaign.basis.acf.push_back(acf(numbers, campaign.study.simulation.samples));
  for (std::int64_t index = 0; index < campaign.study.experiment_count(); ++index) {
    ExperimentRecord made = record(numbers, campaign.study, index);
    made.draw = draw_experiment(campaign.study, index);
    made.status = index == 3   ? ExperimentStatus::infeasible
                  : index == 4 ? ExperimentStatus::failed
                               : ExperimentStatus::ok;
    made.message = index == 4 ? "died" : "";
    made.diagnosis = {};
    made.perturbed = {};
    if (made.status == ExperimentStatus::ok) {
      made.diagnosis = diagnosis(numbers, 2);
      const Eigen::Index samples = campaign.study.simulation.samples;
      for (int cv = 0; cv < 2; ++cv)
        made.diagnosis.cvs.push_back({numbers.index(2) == 1, static_cast<ExperimentKind>(numbers.index(3)),
                                      distribution(numbers), acf(numbers, samples), numbers.next()});
    }
    campaign.records.push_back(std::move(made));
  }
  campaign.comparison = made_up_comparison(campaign.study, campaign.records);
  return campaign;
}

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "mpmbench-test-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr)
    throw std::runtime_error("no temporary folder");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string file_content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void make_file(const std::filesystem::path& path, const std::string& content) {
  std::ofstream file(path, std::ios::binary);
  file << content;
}

}  // namespace mpm::testing
