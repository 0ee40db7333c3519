// usage: fuzz_inputs SOURCE_FOLDER COUNT [SEED] [KIND [FIRST]]
//
// COUNT damaged inputs of every kind in turn, or of one kind from the FIRST on, each drawn from the seed and
// its number alone. An input must be read or refused: InputError, ArchiveError or a failure of a program,
// which is plain text. A COUNT of 1 says why it is refused. Another exception, a report of a sanitizer or an
// input that takes a minute of the processor ends the program; the file that the first line names then holds
// the number of the input, with which FIRST tries it again. Exit code 0 when every kind has inputs of both
// sorts.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/time.h>
#include <unistd.h>

#include "analysis/methods/method_file.hpp"
#include "analysis/methods/method_messages.hpp"
#include "analysis/methods/outside_program.hpp"
#include "analysis/reproduction/scenario_quantities.hpp"
#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "analysis/study_files/suite_file.hpp"
#include "analysis/study_files/sweep_file.hpp"
#include "analysis/study_files/table_file.hpp"
#include "base/error.hpp"
#include "base/system/child_process.hpp"
#include "base/system/program_trust.hpp"
#include "bench/campaign/campaign_loops.hpp"
#include "bench/commands/step_model.hpp"
#include "bench/parts/part_folder.hpp"
#include "bench/shards/shard.hpp"
#include "bench/shards/shard_identity.hpp"
#include "plants/nonlinear/foreign_plant.hpp"
#include "plants/outside/fmu_description.hpp"
#include "plants/outside/fmu_package.hpp"
#include "plants/outside/program_model.hpp"
#include "results/archive/archive.hpp"
#include "results/archive/method_json.hpp"
#include "results/blind/blind_loops.hpp"
#include "results/blind/verdict_file.hpp"
#include "results/files/archive_error.hpp"
#include "results/files/file_seal.hpp"
#include "results/files/utf8.hpp"
#include "results/gates/gate_check.hpp"
#include "results/gates/gate_file.hpp"
#include "results/records/data_sketch.hpp"
#include "results/records/netcdf_columns.hpp"
#include "results/records/plant_record_file.hpp"
#include "results/records/record_file.hpp"
#include "results/suite/board_file.hpp"
#include "scenarios/controller/controller_program.hpp"
#include "solvers/qp_solver_factory.hpp"
#include "tests/results/made_up_campaign.hpp"
#include "tests/scenarios/mutator.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;
namespace fs = std::filesystem;

constexpr std::uint64_t kNetcdfSamples = 60;  // of foreign_record.nc
constexpr double kNetcdfPatience = 10;        // s for HDF5, which comes to no end with some of them
constexpr long kPatience = 60;                // s of the processor for one input
constexpr unsigned kDeadline = 3600;          // s for one that waits, on however busy a machine
constexpr double kAnswerTime = 5;             // s for an answer of a program

/// One kind of input: a whole one, how it is damaged, and how it is read.
struct Kind {
  std::string name;
  std::vector<std::string> whole;
  bool is_text = true;
  std::function<void(const std::string& content)> read;
  std::vector<std::pair<std::string, std::string>> swaps = {};  ///< what people and programs write otherwise
  std::int64_t accepted = 0;
  std::int64_t refused = 0;
  std::int64_t crashed = 0;  ///< refused since HDF5 crashed or came to no end, in a process of its own
};

std::vector<std::byte> bytes_of(const std::string& content) {
  const auto bytes = std::as_bytes(std::span(content));
  return {bytes.begin(), bytes.end()};
}

/// Reads a file with any content by its path.
template <class Load>
auto from_file(const fs::path& file, const Load& load) {
  return [file, load](const std::string& content) {
    fs::remove(file);  // ext4 would flush a file that takes the place of its old content
    make_file(file, content);
    load(file);
  };
}

const char* const kSweep =
    "[sweep]\nname = \"s\"\ntitle = \"t\"\nstudy = \"small.toml\"\n[[variant]]\nchoice = \"noise\"\n"
    "value = \"none\"\nset.simulation.noise_standard_deviation = 0.0\n[[variant]]\nchoice = \"steps\"\n"
    "value = \"other\"\nremove = [\"simulation.step\"]\nset.simulation.random_steps = {interval = "
    "{constant = 9}, level = {constant = 1}}\n";
const char* const kSuite =
    "[suite]\nname = \"s\"\nversion = \"1.0\"\ntitle = \"t\"\nseed = 7\nmethods = [\"sse\"]\n[common]\n"
    "set.simulation.samples = 110\n[[plant]]\nname = \"a\"\nstudy = \"small.toml\"\n[[family]]\n"
    "name = \"f\"\ntitle = \"t\"\nset.experiments = {mpm = 1, ud = 2, mpm_ud = 0}\n[[family]]\n"
    "name = \"g\"\ntitle = \"u\"\nplants = [\"a\"]\n";
const char* const kMethods =
    "[method.mine]\ncommand = [\"python3\", \"mine.py\"]\ntime_limit = 60\noptions = {threshold = 1.5, x = "
    "[1, {y = true}]}\n[method.other]\ncommand = [\"octave-cli\"]\n";
const char* const kGates =
    "inconclusive = \"pass\"\nconfidence = 0.9\nmaximum_failed = 3\n[[gate]]\naggregate = \"infeasible\"\n"
    "maximum = 0.1\n[[gate]]\naggregate = \"mpm.slope\"\nminimum = -1\nmaximum = 2.5\nreason = \"a text\"\n"
    "[baseline]\narchive = \"old/a.h5\"\nsignificance = 0.01\n";
const char* const kFmu = R"(<?xml version="1.0"?><fmiModelDescription fmiVersion="2.0" guid="{1}">
<CoSimulation modelIdentifier="m"/><ModelVariables>
  <ScalarVariable name="u" valueReference="3" causality="input"><Real/></ScalarVariable>
  <ScalarVariable name="y" valueReference="0" causality="output"><Real unit="K"/></ScalarVariable>
  <ScalarVariable name="n" valueReference="5" causality="input"><Integer/></ScalarVariable>
  <ScalarVariable name="k" valueReference="7" causality="parameter" variability="tunable"><Real/></ScalarVariable>
</ModelVariables></fmiModelDescription>)";
const char* const kAnswer =
    R"({"flagged": true, "score": 1.5, "cv": "xD", "source": "mpm", "channels": [["xD", "R"], ["xB", "S"]],
"mismatch": {"channel": ["xD", "R"], "parameter": "gain", "size": 1.2, "lower": 1.1, "upper": 1.3},
"candidate": 1, "numbers": {"total": 3, "each": [1, 2], "gain": [[1, 2], [3, null]]}})";

const char* const kControllerAnswers =
    "{\"number\": 1, \"on_model\": true}\n{\"number\": 2}\n{\"number\": 3}\n"
    "{\"number\": 4, \"u\": [0.5, -2e-3], \"u_target\": [0, 1]}\n";
const char* const kMethodAnswer =
    R"({"number": 1, "title": "Mine", "verdict": "v", "needs": ["setpoints", "corrected"], )"
    R"("signals": "lists", "answers": ["cv", "source", "probabilities"], "methods": ["sse"], )"
    R"("stated_false_alarms": 0.05, "numbers": [{"name": "total", "scope": "loop", "meaning": "m"}, )"
    R"({"name": "each", "scope": "cv"}]})"
    "\n";

std::string record_csv() {
  std::string text = "time;xD;xB;R;S;F\n";
  for (int k = 0; k < 60; ++k)
    text +=
        fmt::format("2024-03-01 12:{:02}:00;{};{};{};0.25;{}\n", k, 0.01 * k, 1 - 0.02 * k, k % 7, k / 20);
  return text;
}

/// A row a value, with qualities, and stamps in French.
std::string record_table() {
  std::string text = "TagName,EventTime,Status,Value\n";
  for (int k = 0; k < 60; ++k)
    for (const char* tag : {"xD", "xB", "R", "S", "F"})
      text +=
          fmt::format("{},01-ao\xC3\xBBt-24 12:{:02}:00,{},{}\n", tag, k, k == 7 ? "Bad" : "Good", 0.01 * k);
  return text;
}

std::string step_responses() {
  std::string text = "time,y/u,y/v,z/u\n";
  for (int k = 1; k <= 40; ++k)
    text += fmt::format("{},{:.5f},{:.3e},{}\n", 2 * k, 1.5 - 1.5 * std::exp(-0.2 * k), 0.1 * k,
                        k < 5 ? 0.0 : std::exp(-0.1 * k) - 1.0);
  return text;
}

MethodDescription answering_all() {
  MethodDescription method;
  method.name = "mine";
  method.locates_cvs = method.tells_sources = method.names_channels = method.names_mismatches =
      method.names_candidates = true;
  method.numbers = {
      {"total", NumberScope::loop, ""}, {"each", NumberScope::cv, ""}, {"gain", NumberScope::channel, ""}};
  return method;
}

/// What is written otherwise in records: quotes, stamps, fillers, line ends.
std::vector<std::pair<std::string, std::string>> csv_swaps() {
  return {{";", ";\""},           {";", "\";"},      {"\n", "\"\n"},        {";0", ";5\" pipe"},
          {"\n", "\r"},           {":00;", ":00Z;"}, {":00;", ":00 PM;"},   {":00;", ":00+99:99;"},
          {" 12:", " 24:"},       {" 12:", " 99:"},  {"2024", "0024"},      {"2024-03-01 ", "1709251200"},
          {";0", ";-9999"},       {";0", ";1e308"},  {";0", ";9.96921e36"}, {";0", ";\"\"\"0\"\"\""},
          {"time", "\"ti\nme\""}, {"time", ""},      {";xD", ";=xD"},       {"\n", ";\n"}};
}

/// Words of other languages, code pages and qualities, and what stands in their place.
std::vector<std::pair<std::string, std::string>> table_swaps() {
  return {{"ao\xC3\xBBt", "ao\xFBt"},
          {"ao\xC3\xBBt", "lis"},
          {"ao\xC3\xBBt", "8\xE6\x9C\x88"},
          {"ao\xC3\xBBt", "mar"},
          {"ao\xC3\xBBt", ""},
          {":00,", ":00 p. m.,"},
          {":00,", ":00 du,"},
          {"01-", "mar 01-"},
          {"-24 ", "-24 de "},
          {"Good", "192"},
          {"Good", ""},
          {"Good", "0x80000000"},
          {"Bad", "1e30"},
          {"Status", "Value"},
          {"Status", "Quality"},
          {"TagName", "name"},
          {"xD,", "xD.Status,"},
          {"xB,", ","},
          {",0", ",1000"},
          {"EventTime", "p. m."},
          {"Value", "xD"}};
}

std::vector<std::pair<std::string, std::string>> step_swaps() {
  return {{"y/v", "y/u"},   {"y/u", "y"},    {"y/u", "/u"},  {"time", "Time"},
          {"time", "t/x"},  {"0.", "1e400"}, {"0.", "-0."},  {"\n2", "\n0"},
          {"0.", "1e-320"}, {"z/u", "u/z"},  {",0", ",nan"}, {"e-0", "e+30"}};
}

std::vector<std::pair<std::string, std::string>> verdict_swaps() {
  return {{",", ",\""},
          {"\"\"", "\""},
          {"\n", "\"\n"},
          {",", ";"},
          {"1,yes", "1.0,1.0"},
          {"loop", ",loop"},
          {"\n", "\r"},
          {"7.5", "nan"},
          {"2,", "2.0,"},
          {"#", "\xEF\xBB\xBF#"},
          {"0,0", "0,WAHR"},
          {"-inf", "7,5"},
          {"flagged,", "flagged,window,"}};
}

/// Letters, numbers and keys of a board that another one might have.
std::vector<std::pair<std::string, std::string>> board_swaps() {
  return {{"\"cells\"", "\"methods\""},
          {"\"outcomes_2\"", "\"outcomes_9\""},
          {"\"outcomes\"", "\"outcomes_2\""},
          {"\"truths\":\"", "\"truths\":\"\xC3\xBF"},
          {"\"outcomes\":\"", "\"outcomes\":\"~"},
          {":null", ":1e308"},
          {"0.", "-0."},
          {":0", ":9007199254740992"},
          {":0", ":-1"},
          {",\"", ",null,\""},
          {"[", "[["},
          {"\"sse\"", "\"order\""},
          {"wood-berry", "__proto__"}};
}

/// Other lengths of its variables and other attributes in a netCDF-4 file of kNetcdfSamples samples.
std::vector<std::pair<std::string, std::string>> netcdf_swaps() {
  const auto length = [](std::uint64_t samples) {
    return std::string(reinterpret_cast<const char*>(&samples), sizeof samples);
  };
  std::vector<std::pair<std::string, std::string>> swaps{{"2024-", "0024-"},
                                                         {"minutes", "months "},
                                                         {"minutes", "nanosec"},
                                                         {" since ", "  since"},
                                                         {"scale_factor", std::string("_FillValue\0\0", 12)},
                                                         {"add_offset", "_FillValue"},
                                                         {"standard", "360_days"}};
  for (const std::uint64_t other : {0ULL, 1ULL, 59ULL, 61ULL, 6000ULL, 1ULL << 40, ~0ULL})
    for (int often = 0; often < 3; ++often)
      swaps.emplace_back(length(kNetcdfSamples), length(other));
  return swaps;
}

/// What no reader of studies, sweeps, suites, methods and gates takes for its own stays the text of a study.
std::vector<Kind> text_kinds(const fs::path& folder, const fs::path& source) {
  const std::vector<std::string> studies{file_content(source / "tests/scenarios/data/small.toml"),
                                         file_content(source / "scenarios/studies/wood-berry.toml"),
                                         file_content(source / "scenarios/studies/chapter6-scenarios.toml"),
                                         file_content(source / "scenarios/studies/chapter5-tank.toml")};
  make_file(folder / "small.toml", studies[0]);
  const Study study = find_study("wood-berry");
  return {
      {"study", studies, true, [](const std::string& text) { parse_study(text, "s.toml"); }},
      {"sweep", {kSweep}, true, from_file(folder / "sweep.toml", [](const fs::path& f) { load_sweep(f); })},
      {"suite", {kSuite}, true, from_file(folder / "suite.toml", [](const fs::path& f) { load_suite(f); })},
      {"methods",
       {kMethods},
       true,
       from_file(folder / "methods.toml", [](const fs::path& f) { load_method_file(f); })},
      {"gates",
       {kGates},
       true,
       [findings = gate_findings(study)](const std::string& text) { parse_gates(text, "g", findings); }},
      {"records, CSV",
       {record_csv()},
       true,
       [study](const std::string& text) { read_plant_record(study, text, "r.csv"); },
       csv_swaps()},
      {"records, a row a value",
       {record_table()},
       true,
       [study](const std::string& text) {
         data_sketch(study.plant, csv_record_columns(text, "r.csv", study.data));
         read_plant_record(study, text, "r.csv");
       },
       table_swaps()},
      {"step responses",
       {step_responses()},
       true,
       from_file(folder / "steps.csv", [](const fs::path& f) { read_step_model(f.string(), std::nullopt); }),
       step_swaps()},
      {"FMU description", {kFmu}, true, [](const std::string& xml) { parse_fmu_description(xml, "m.fmu"); }},
      {"answer of a method", {kAnswer}, true, [study, method = answering_all()](const std::string& text) {
         const auto answer = nlohmann::ordered_json::parse(text, nullptr, false);
         if (!answer.is_object())
           throw InputError("answer", "no JSON object", "one");
         assessment_of(answer, study.plant, method, "mine");
       }}};
}

/// The command of a program that answers by one line of a file after the other.
std::vector<std::string> answering_by(const fs::path& file) {
  return {"/bin/sh", "-c",
          "exec 3<\"$0\"; while read -r _; do IFS= read -r line <&3 || exit; "
          "printf '%s\\n' \"$line\"; done",
          file.string()};
}

std::string repeated(const std::string& text, int often) {
  std::string all;
  for (int i = 0; i < often; ++i)
    all += text;
  return all;
}

/// The answers of programs: of a plant, of a controller, and of a method on what it is.
std::vector<Kind> program_kinds(const fs::path& file) {
  ProgramSettings settings;
  settings.command = answering_by(file);
  settings.mvs = settings.outputs = 2;
  const auto model = program_model(settings, {.time_limit = kAnswerTime});
  const auto plant = [model](const fs::path&) {
    const auto simulation = model->simulation(1.0);
    simulation->start({}, Eigen::VectorXd::Zero(2));
    simulation->step(Eigen::VectorXd::Ones(2));
    simulation->step(Eigen::VectorXd::Ones(2));
  };
  const auto controller = [study = find_study("wood-berry"), command = settings.command](const fs::path&) {
    const ControllerProgram program(command, kAnswerTime);
    const auto started =
        program.controller(study.plant, study.controller, 60, qp_solver_factory("active-set"));
    const Eigen::VectorXd d = Eigen::VectorXd::Zero(1), y = Eigen::VectorXd::Zero(2);
    started->reset(Eigen::VectorXd::Zero(2), d);
    started->step(y, d);
    if (!started->failure().empty())
      throw ForeignFailure(started->failure());
  };
  const auto method = [command = settings.command](const fs::path&) {
    program_method({.name = "mine", .command = command, .time_limit = kAnswerTime});
  };
  return {{"answers of a plant",
           {"{}\n{\"y\": [1.5, -2e-3]}\n{\"y\": [0, 1e300]}\n"},
           true,
           from_file(file, plant),
           {{"[1.5", "[\"" + repeated("\xC3\xBC", 200) + "\""},
            {"{}", "{\"error\": \"" + repeated("\xC3\xBC", 200) + "\"}"}}},
          {"answers of a controller", {kControllerAnswers}, true, from_file(file, controller)},
          {"description by a method", {kMethodAnswer}, true, from_file(file, method)}};
}

/// Files that others send: boards, FMUs, descriptions of methods in archives.
std::vector<Kind> sent_kinds(const fs::path& folder, const fs::path& source) {
  const auto table = [](const fs::path& file) { load_table(file, ScenarioQuantities::known()); };
  const auto board = [suite = find_suite("quick")](const fs::path& file) { read_board(file, suite); };
  return {{"table of the thesis",
           {file_content(source / "scenarios/tables/table-4.10.toml"),
            file_content(source / "scenarios/tables/figure-2.15.toml")},
           true,
           from_file(folder / "table.toml", table)},
          {"board",
           {file_content(source / "scenarios/suites/quick.board.json")},
           true,
           from_file(folder / "quick.board.json", board),
           board_swaps()},
          {"description of a method",
           {method_description_json(answering_all())},
           true,
           [](const std::string& json) { method_description(json, "a.h5"); }},
          {"FMU",
           {file_content(MPMBENCH_TANK_FMU)},
           false,
           from_file(folder / "m.fmu", [](const fs::path& file) { FmuPackage{file}; }),
           {{"modelDescription.xml", "binaries/linux64/t.so"},
            {"modelDescription.xml", "resources/../../e.xm"},
            {"linux64/tank.so", "../../../tank.so"},
            {"linux64/tank.so", std::string("linux64/t\0nk.so", 15)},
            {"binaries/linux64", "resources/linux6"}}}};
}

/// Archives, and what else is made of campaigns. `campaign` must outlive them.
std::vector<Kind> campaign_kinds(const fs::path& folder, const fs::path& source, const Campaign& campaign) {
  const fs::path archive = folder / "a.h5", shard = folder / "00000001.shard", part = folder / "part";
  write_archive(archive, campaign, findings_of(campaign));
  const std::string whole = file_content(archive);

  fs::create_directory(part);
  PartFolder description;
  description.path = part;
  description.study = find_study("wood-berry");
  description.options.experiments = 40;
  description.loops = 40;
  description.part = {parse_loop_ranges("0:10,20:30", 40), PartNumber{1, 2, ""}};
  write_part_description(description);

  const ShardIdentity identity = shard_identity(campaign.study, {});
  const auto loops = std::make_shared<const CampaignLoops>(campaign.study, RunOptions());
  ShardBytes bytes;
  ExperimentOutcome outcome;
  outcome.record = campaign.records.front();
  bytes.add(outcome.record.draw.index, loops->result(outcome.record.draw.index, outcome).bytes);
  bytes.write(shard, identity, 1.5);
  const std::string sealed_shard = file_content(shard);
  const auto read = [identity, loops](const fs::path& file) {
    const std::optional<ShardContent> content = read_shard(file, identity);
    if (!content)
      throw InputError("shard", "damaged", "a whole one");
    const std::string read_bytes = file_content(file);
    for (const ShardPlace& place : content->places)
      loops->outcome({.key = place.key, .bytes = read_bytes.substr(place.begin, place.size), .shard = &file});
  };
  const std::string verdicts = hash_line(loops_hash(campaign, false)) +
                               "loop,flagged,score,cv,source,channels,parameter,size,error\n"
                               "1,yes,7.5,,,,,,\n0,0,-inf,,,,,,\n2,,,,,,,,\"no, \"\"not\"\" it\"\n";
  const auto resealed = [](const std::string& content) {
    const std::vector<std::byte> file = sealed(bytes_of(content));
    return std::string(reinterpret_cast<const char*>(file.data()), file.size());
  };
  return {
      {"archive", {whole}, false, from_file(archive, [](const fs::path& f) { read_archive(f); })},
      {"records, netCDF",
       {whole},
       false,
       [](const std::string& content) {
         netcdf_columns(bytes_of(content), "r.nc", "experiment", kNetcdfPatience);
       }},
      {"records, netCDF of others",
       {file_content(source / "tests/reliability/foreign_record.nc")},
       false,
       [](const std::string& content) { netcdf_columns(bytes_of(content), "r.nc", "time", kNetcdfPatience); },
       netcdf_swaps()},
      {"description of a part",
       {file_content(part / "campaign.json")},
       true,
       from_file(part / "campaign.json", [part](const fs::path&) { read_part(part); })},
      {"shard", {sealed_shard}, false, from_file(shard, read)},
      {"shard, checksum right",
       {sealed_shard.substr(0, sealed_shard.size() - kSealBytes)},
       false,
       [write_and_read = from_file(shard, read), resealed](const std::string& content) {
         write_and_read(resealed(content));
       }},
      {"verdicts",
       {verdicts},
       true,
       from_file(folder / "mine.csv", [&campaign](const fs::path& f) { read_verdicts(f, "mine", campaign); }),
       verdict_swaps()}};
}

/// One to three of the swaps of the kind, each at the next place behind a random one that has it.
std::string swapped(const Kind& kind, std::string text, Mutator& mutator) {
  for (std::size_t n = mutator.below(3) + 1; n > 0; --n) {
    const auto& [from, to] = kind.swaps[mutator.below(kind.swaps.size())];
    std::size_t at = text.find(from, mutator.below(text.size() + 1));
    if (at == std::string::npos)
      at = text.find(from);
    if (at != std::string::npos)
      text.replace(at, from.size(), to);
  }
  return text;
}

/// One input in 16 is random bytes, one the whole one; the others are changed in one to four places, half of
/// those with swaps by these.
std::string damaged(const Kind& kind, Mutator& mutator) {
  const std::string& whole = kind.whole[mutator.below(kind.whole.size())];
  const std::size_t way = mutator.below(16);
  if (way == 0)
    return mutator.random_bytes(2000);
  if (way == 1)
    return whole;
  if (!kind.swaps.empty() && way % 2 == 0)
    return swapped(kind, whole, mutator);
  return kind.is_text && way < 14 ? mutator.mutated_toml(whole) : mutator.mutated_bytes(whole);
}

/// Reads the input, or refuses it.
void read(Kind& kind, const std::string& content, bool says_why) {
  std::string why;
  try {
    kind.read(content);
    ++kind.accepted;
    return;
  } catch (const InputError& error) {
    why = error.what();
  } catch (const ArchiveError& error) {
    why = error.what();
  } catch (const ForeignFailure& error) {
    why = error.what();
    if (plain_text(why) != why)  // archives and pages take it as it is
      throw std::logic_error("a failure that is no plain text: " + plain_text(why));
  }
  if (says_why)
    std::printf("%s\n", why.c_str());
  ++(why.find("a file that HDF5 cannot read (") != std::string::npos ? kind.crashed : kind.refused);
}

void try_input(Kind& kind, std::uint64_t seed, bool says_why) {
  Mutator mutator(seed);
  constexpr itimerval kStart{{0, 0}, {kPatience, 0}}, kStop{};
  ::setitimer(ITIMER_PROF, &kStart, nullptr);
  ::alarm(kDeadline);
  read(kind, damaged(kind, mutator), says_why);
  ::alarm(0);
  ::setitimer(ITIMER_PROF, &kStop, nullptr);
}

bool fuzz(std::vector<Kind>& kinds, const std::string& only, std::int64_t first, std::int64_t count,
          std::uint64_t seed, const fs::path& at) {
  for (Kind& kind : kinds) {
    if (!only.empty() && kind.name != only)
      continue;
    std::ofstream number(at);
    for (std::int64_t i = first; i < first + count; ++i) {
      number.seekp(0);
      number << kind.name << ' ' << i << '\n' << std::flush;
      try_input(kind, seed * 1'000'000'007U + static_cast<std::uint64_t>(i), count == 1);
    }
    fmt::print("{:8} read {:8} refused {:5} crashed  {}\n", kind.accepted, kind.refused, kind.crashed,
               kind.name);
    std::fflush(stdout);
    if (count >= 200 && (kind.accepted == 0 || kind.refused == 0))
      return false;  // a reader that accepts or refuses everything is no reader
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  mpm::trust_every_program();
  if (argc < 3)
    return 2;
  const std::int64_t count = std::atoll(argv[2]);
  const std::uint64_t seed = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1;
  const fs::path at = fs::temp_directory_path() / fmt::format("fuzz_inputs.{}", ::getpid());
  try {
    const mpm::testing::TemporaryFolder folder;
    const Campaign campaign = drawn_campaign();
    std::vector<Kind> kinds = text_kinds(folder.path(), argv[1]);
    for (std::vector<Kind>& more :
         std::array{program_kinds(folder / "answers"), sent_kinds(folder.path(), argv[1]),
                    campaign_kinds(folder.path(), argv[1], campaign)})
      std::move(more.begin(), more.end(), std::back_inserter(kinds));
    std::printf("the number of the input is in %s\n", at.c_str());
    std::fflush(stdout);
    const bool both =
        fuzz(kinds, argc > 4 ? argv[4] : "", argc > 5 ? std::atoll(argv[5]) : 0, count, seed, at);
    fs::remove(at);
    return both ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", at.c_str(), error.what());
    return 1;
  }
}
