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
#include "analysis/methods/thesis/chain_numbers.hpp"
#include "analysis/study_files/study_file.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/random/random_stream.hpp"

namespace mpm::testing {
namespace {

std::string small_study() {
  return file_content(MPMBENCH_SOURCE_DIR "/tests/scenarios/data/small.toml");
}

constexpr const char* kMethods = "\n[methods]\nnames = ['all']\n";
constexpr const char* kReplications = "\n[aggregate]\nbootstrap_replications = 200\n";
constexpr const char* kS0Perturbation =
    "\n[s0_perturbation]\nmultipliers = [0.5, 1, 2]\nfixed_mvs = ['hot']\nfixed_active_cvs = ['level']\n";

/// Numbers, one in eight of them an awkward one.
class Numbers {
 public:
  explicit Numbers(std::uint64_t which = 2) : stream_(which, 3, StreamId::measurement_noise) {}
  double next() {
    switch (stream_.below(40)) {
      case 0:
        return std::bit_cast<double>(std::uint64_t{0x7FF8000000ABCDEF});  // a NaN with a payload
      case 1:
        return kInfinity;
      case 2:
        return -kInfinity;
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
  RandomStream stream_;
};

SolverStatistics solver(Numbers& numbers) {
  return {numbers.whole(), numbers.whole(), numbers.whole(), numbers.next()};
}

MpmIndicator indicator(Numbers& numbers) {
  return {numbers.next(), numbers.next(),     numbers.next(),    numbers.next(),
          numbers.next(), numbers.index(100), numbers.index(100)};
}

/// Any numbers for quantities, any of the words for verdicts.
template <class Owner>
void fill(Numbers& numbers, Owner& owner, const std::vector<Row<Owner>>& rows) {
  for (const Row<Owner>& row : rows) {
    const std::vector<NumberWord>& words = row.text.words;
    const double value = words.empty() ? numbers.next() : numbers.index(std::ssize(words));
    put_numbers(row, owner, &value);
  }
}

DistributionIndicators distribution(Numbers& numbers) {
  DistributionIndicators made;
  made.mpm = indicator(numbers);
  fill(numbers, made, distribution_rows());
  fill(numbers, made, scatter_rows());
  return made;
}

AcfComparison acf(Numbers& numbers, Eigen::Index samples) {
  AcfComparison made;
  fill(numbers, made, acf_rows());
  for (AcfFeatures* features : {&made.y, &made.y0, &made.y0_diag})
    features->values = numbers.vector(samples / 4 + 1);
  return made;
}

CvDiagnosis cv_diagnosis(Numbers& numbers, const Study& study) {
  CvDiagnosis made;
  made.flagged = numbers.index(2) == 1;
  if (made.flagged)
    made.source = numbers.index(2) == 1 ? FaultSource::mpm : FaultSource::ud;
  made.distribution = distribution(numbers);
  made.acf = acf(numbers, study.simulation.samples);
  made.sse = numbers.next();
  return made;
}

/// The numbers of the chain without a verdict; those of every CV in a study of named scenarios.
Diagnosis diagnosis_numbers(Numbers& numbers, const Study& study) {
  Diagnosis made;
  made.ivar = numbers.vector(study.cv_count());
  made.ivar_diag = numbers.vector(study.cv_count());
  made.indicator = indicator(numbers);
  made.alone = {numbers.next(), numbers.next(), numbers.next()};
  if (study.names_scenarios())
    for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
      made.cvs.push_back(cv_diagnosis(numbers, study));
  return made;
}

Diagnosis diagnosis(Numbers& numbers, const Study& study) {
  Diagnosis made = diagnosis_numbers(numbers, study);
  made.impactful = numbers.index(2) == 1;
  made.predicted_cv = numbers.index(study.cv_count());
  made.predicted_source = numbers.index(2) == 1 ? FaultSource::mpm : FaultSource::ud;
  return made;
}

/// One number of a method that this place allows: a word, or none; or any quantity.
double number_for(Numbers& numbers, const NumberPlace& place) {
  const auto words = static_cast<Eigen::Index>(place.info.words.size());
  if (words == 0)
    return numbers.next();
  const int word = numbers.index(words + 1);
  return word == words ? kNaN : word;
}

/// Any answer that a method may give, or none, mostly one.
AssessmentRecord answer(Numbers& numbers, const Study& study, std::shared_ptr<const AssessmentForm> form) {
  const MethodDescription& method = form->method();
  AssessmentRecord made = unasked(std::move(form));
  made.milliseconds = 0.1 * numbers.index(1000);
  made.status = static_cast<AssessmentStatus>(std::max(0, numbers.index(7) - 3));
  if (made.status == AssessmentStatus::not_applicable || made.status == AssessmentStatus::failed)
    made.reason = "no \xC3\xBC";
  if (!made.answered())
    return made;
  made.flagged = numbers.index(2) == 1;
  made.score = numbers.next();
  const bool must_name_cv = made.flagged && method.locates_cvs;
  made.predicted_cv =
      must_name_cv ? numbers.index(study.cv_count()) : numbers.index(study.cv_count() + 1) - 1;
  made.predicted_source = static_cast<FaultSource>(numbers.index(3));
  made.numbers.resize(made.form->size());
  for (const NumberPlace& place : made.form->places())
    for (Eigen::Index i = 0; i < place.size(); ++i)
      made.numbers(place.first + i) = number_for(numbers, place);
  return made;
}

/// The chain always gives an answer, and the others any, where the loop ran to its end. Each method has
/// numbers of its own, so that those of the others stay when one is added behind them.
void assess(Numbers& numbers, const Campaign& campaign, ExperimentRecord& record) {
  std::uint64_t own = 100 * static_cast<std::uint64_t>(record.draw.index + 1);
  for (const CampaignMethod& method : campaign.methods) {
    Numbers of_method(++own);
    record.assessments.push_back(unasked(method.form));
    if (record.status != ExperimentStatus::ok)
      continue;
    if (method.form->method().name == "botelho")
      set_chain(campaign.study, record, diagnosis(numbers, campaign.study));
    else
      record.assessments.back() = answer(of_method, campaign.study, method.form);
  }
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
          study.record.resamples() ? numbers.matrix(study.cv_count(), samples) : Eigen::MatrixXd(),
          solver(numbers),
          status == ControlStatus::failed ? LoopFailure::plant : LoopFailure::none,
          status == ControlStatus::failed ? "it ran \xC3\xBC"
                                            "ber"
                                          : ""};
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

/// An experiment with a fault of any kind and size, as no study would draw it.
ExperimentDraw made_up_draw(Numbers& numbers, const Study& study, std::int64_t index) {
  ExperimentDraw made;
  made.index = index;
  made.kind = static_cast<ExperimentKind>(1 + index % 3);
  const Eigen::Index cv = numbers.index(study.cv_count());
  if (made.kind != ExperimentKind::ud)
    made.mismatches = {made_up_mismatch(numbers, study, cv)};
  if (made.kind != ExperimentKind::mpm)
    made.disturbances = {made_up_disturbance(numbers, cv)};
  return made;
}

ExperimentStatus made_up_status(std::int64_t index) {
  return index % 5 == 3   ? ExperimentStatus::infeasible
         : index % 7 == 4 ? ExperimentStatus::failed
                          : ExperimentStatus::ok;
}

ControlStatus loop_status(ExperimentStatus status) {
  return status == ExperimentStatus::ok           ? ControlStatus::ok
         : status == ExperimentStatus::infeasible ? ControlStatus::infeasible
                                                  : ControlStatus::failed;
}

ExperimentRecord record(Numbers& numbers, const Campaign& campaign, ExperimentDraw draw,
                        ExperimentStatus status) {
  const Study& study = campaign.study;
  const bool ran = status == ExperimentStatus::ok;
  const std::int64_t index = draw.index;
  ExperimentRecord made;
  made.draw = std::move(draw);
  made.status = status;
  if (ran)
    made.ivar_basis = numbers.vector(study.cv_count());
  if (status == ExperimentStatus::failed)
    made.message = "died: \xC3\xBC \xE6\xB8\xAC";
  const auto multipliers = static_cast<Eigen::Index>(study.s0_perturbation.multipliers.size());
  if (ran && multipliers > 0 && index % 4 == 1)
    made.perturbed = {numbers.vector(multipliers), numbers.vector(multipliers)};
  assess(numbers, campaign, made);
  made.solver = solver(numbers);
  if (index % 2 == 1)
    made.loop = {trajectory(numbers, study, loop_status(status)),
                 numbers.matrix(study.cv_count(), study.simulation.samples)};
  return made;
}

void add_methods(Campaign& campaign) {
  campaign.study.methods = shipped_methods().names();
  campaign.methods = made_up_methods(campaign.study);
}

AuditDifference difference(Numbers& numbers) {
  return {numbers.index(2) == 1, numbers.next(), numbers.next()};
}

BasisCase basis_case(Numbers& numbers, const Study& study, const std::vector<ActiveConstraint>& active) {
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
  made.diagnosis = diagnosis_numbers(numbers, study);
  for (CvDiagnosis& cv : made.diagnosis.cvs) {
    cv.flagged = false;
    cv.source = FaultSource::none;
  }
  made.healthy = true;
  made.explanation = "fine";
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

AssessmentRecord unasked(std::shared_ptr<const AssessmentForm> form) {
  AssessmentRecord record;
  record.form = std::move(form);
  return record;
}

AssessmentRecord plain_verdict(std::shared_ptr<const AssessmentForm> form, bool flagged, double score) {
  Assessment said;
  said.flagged = flagged;
  said.score = score;
  AssessmentRecord record = kept(std::move(form), said);
  if (flagged && record.form->method().locates_cvs)
    record.predicted_cv = 0;
  return record;
}

std::vector<CampaignMethod> made_up_methods(const Study& study) {
  std::vector<CampaignMethod> methods;
  for (auto& form : assessment_forms(study, shipped_methods().names()))
    methods.push_back({std::move(form), "1.3.0", "def", "mpmbench compare \xC3\xBC.h5"});
  return methods;
}

AssessmentRecord made_up_answer(const Study& study, std::shared_ptr<const AssessmentForm> form,
                                std::uint64_t which) {
  Numbers numbers(which);
  return answer(numbers, study, std::move(form));
}

void set_chain(const Study& study, ExperimentRecord& record, const Diagnosis& diagnosis) {
  const auto chain =
      std::find_if(record.assessments.begin(), record.assessments.end(),
                   [](const AssessmentRecord& said) { return said.form->method().name == "botelho"; });
  if (chain == record.assessments.end())
    throw std::logic_error("the chain is no method of this record");
  Assessment said;
  said.flagged = diagnosis.impactful;
  said.score = 0.5;
  for (Eigen::Index cv = 0; cv < diagnosis.ivar_diag.size(); ++cv) {
    const double ivar_diag = diagnosis.ivar_diag(cv);
    CvAssessment of_cv{study.diagnosis.has_impact(ivar_diag), std::abs(ivar_diag - 1.0),
                       cv == diagnosis.predicted_cv ? diagnosis.predicted_source : FaultSource::none};
    if (!diagnosis.cvs.empty()) {
      const CvDiagnosis& alone = diagnosis.cvs[static_cast<std::size_t>(cv)];
      of_cv.flagged = alone.flagged;
      of_cv.source = alone.source;
    }
    said.cvs.push_back(of_cv);
  }
  said.numbers = chain_numbers(diagnosis);
  *chain = kept(chain->form, said);
  chain->predicted_cv = diagnosis.predicted_cv;
  chain->predicted_source = diagnosis.predicted_source;
  chain->milliseconds = 125.0;
}

void remove_methods(Campaign& campaign, const std::function<bool(const std::string& name)>& unwanted) {
  const auto go = [&](auto& list, const auto& form_of) {
    list.erase(std::remove_if(list.begin(), list.end(),
                              [&](const auto& each) { return unwanted(form_of(each)->method().name); }),
               list.end());
  };
  go(campaign.methods, [](const CampaignMethod& method) { return method.form; });
  for (ExperimentRecord& record : campaign.records)
    go(record.assessments, [](const AssessmentRecord& said) { return said.form; });
  campaign.study.methods = method_names(campaign);
}

Campaign made_up_campaign() {
  Numbers numbers;
  Campaign campaign;
  campaign.study =
      parse_study(with_setpoint(small_study()) + kReplications + kS0Perturbation + kMethods, "small");
  campaign.study.seed = 18446744073709551615U;  // not the one in the text, and above the signed range
  campaign.info = {"1.2.3",
                   "abc+",
                   "2015-04-01T12:00:00Z",
                   "mpmbench run \xC3\xBC.toml",
                   "plant.fmu a.fmu 01",
                   "ipopt",
                   0.1,
                   3,
                   0.25,
                   0.7};
  add_methods(campaign);
  campaign.basis =
      basis_case(numbers, campaign.study, {{1, ConstraintKind::upper_limit}, {0, ConstraintKind::setpoint}});
  campaign.basis.sensitivity_fixed =
      NominalSensitivity{2, {{0, ConstraintKind::lower_limit}}, {numbers.matrix(2, 17)}};
  for (std::int64_t index = 0; index < 40; ++index)
    campaign.records.push_back(
        record(numbers, campaign, made_up_draw(numbers, campaign.study, index), made_up_status(index)));
  for (std::int64_t step = 0; step < 5; ++step)
    campaign.audit.push_back(
        {numbers.whole(), step, difference(numbers), difference(numbers), numbers.next()});
  return campaign;
}

Campaign drawn_campaign() {
  Campaign campaign = made_up_campaign();
  for (ExperimentRecord& record : campaign.records)
    record.draw = draw_experiment(campaign.study, record.draw.index);
  return campaign;
}

Campaign faultless_campaign() {
  Numbers numbers;
  std::string text = with_setpoint(small_study());
  const std::string last_count = "mpm_ud = 1\n";
  text.replace(text.find(last_count), last_count.size(), "mpm_ud = 0\nhealthy = 3\ntuning = 8\n");
  const std::string noise = "noise_standard_deviation = 0.01\n";
  text.insert(text.find(noise) + noise.size(), "noise = {factor = {uniform = [0.5, 2]}}\n");
  Campaign campaign;
  campaign.study = parse_study(text + kReplications + kMethods, "small");
  campaign.info = {"1.2.3", "abc", "2015-04-01T12:00:00Z", "mpmbench run x.toml", "", "ipopt", 0.1, 3,
                   0.0,     0.0};
  add_methods(campaign);
  campaign.basis = basis_case(numbers, campaign.study, {{1, ConstraintKind::upper_limit}});
  for (std::int64_t index = 0; index < 48; ++index)
    campaign.records.push_back(
        record(numbers, campaign, draw_experiment(campaign.study, index), made_up_status(index)));
  return campaign;
}

Campaign rich_campaign() {
  Numbers numbers;
  std::string text = with_setpoint(small_study());
  const std::string last_count = "mpm_ud = 1\n";
  text.replace(text.find(last_count), last_count.size(), "mpm_ud = 1\nother = 3\n");
  text +=
      "\n[mismatch]\nextent_weights = {parameter = 1, channel = 1, mv = 1}\nimpact = {uniform = [0.5, 2]}\n"
      "[disturbance]\nsignal_weights = {white = 1, step = 1, sine = 1}\n"
      "place_weights = {cv = 1, mv = 1, several = 1}\nimpact = {uniform = [0.5, 2]}\n"
      "[onset]\nsample = {uniform = [10, 20]}\ngrowth = {uniform = [0, 9]}\n"
      "[monitoring]\nwindow = 24\nstride = 3\n";
  Campaign campaign;
  campaign.study = parse_study(text + kReplications + kMethods, "small");
  campaign.info = {"1.2.3", "abc", "2015-04-01T12:00:00Z", "mpmbench run x.toml", "", "ipopt", 0.1, 3,
                   0.0,     0.0};
  add_methods(campaign);
  campaign.basis = basis_case(numbers, campaign.study, {{1, ConstraintKind::upper_limit}});
  for (std::int64_t index = 0; index < 48; ++index) {
    const double scale = 0.5 + 0.1 * static_cast<double>(index);
    const ExperimentDraw draw =
        with_scales(campaign.study, draw_experiment(campaign.study, index), {scale, 1.0 / scale, 0.3});
    campaign.records.push_back(record(numbers, campaign, draw, made_up_status(index)));
  }
  return campaign;
}

Campaign streamed_from(const Campaign& campaign) {
  Campaign streamed = campaign;
  streamed.records.clear();
  streamed.streamed = RecordRange(campaign.records);
  return streamed;
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
  add_methods(campaign);
  campaign.basis = basis_case(numbers, campaign.study, {});
  return campaign;
}

Campaign scenario_campaign() {
  Numbers numbers;
  std::string text = small_study();
  text.erase(text.find("[experiments]"));
  Campaign campaign;
  campaign.study =
      parse_study(text + "[sensitivity]\nform = 'box-jenkins'\n" + kMethods + kScenarios, "small");
  campaign.info = {"1.2.3", "abc", "2015-04-01T12:00:00Z", "mpmbench run x.toml", "", "ipopt", 0.1, 3,
                   0.0,     0.0};
  add_methods(campaign);
  campaign.basis = basis_case(numbers, campaign.study, {{1, ConstraintKind::upper_limit}});
  campaign.basis.sensitivity_direct = campaign.basis.sensitivity;
  campaign.basis.sensitivity_direct->step_response[0](1, 2) += 0.5;
  for (std::int64_t index = 0; index < campaign.study.experiment_count(); ++index) {
    const ExperimentStatus status = index == 3   ? ExperimentStatus::infeasible
                                    : index == 4 ? ExperimentStatus::failed
                                                 : ExperimentStatus::ok;
    campaign.records.push_back(record(numbers, campaign, draw_experiment(campaign.study, index), status));
  }
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
