#include <filesystem>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/study_files/study_library.hpp"
#include "bench/command_line.hpp"
#include "results/archive/archive.hpp"
#include "results/archive/csv_table.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;
using Catch::Contains;
namespace fs = std::filesystem;

using Words = std::vector<std::string>;

CommandResult typed(const Words& words) {
  std::vector<const char*> line{"mpmbench"};
  for (const std::string& word : words)
    line.push_back(word.c_str());
  return execute(static_cast<int>(line.size()), line.data());
}

Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// What is said about words that are no command, or name input that is wrong.
std::string complaint(const Words& words) {
  const CommandResult result = typed(words);
  CHECK(result.code == ExitCode::bad_input);
  return result.message;
}

TEST_CASE("command line: each option of run arrives where it is used") {
  const TemporaryFolder folder;
  const std::string output = folder / "an archive.h5";
  const CommandResult result =
      typed({"run", "wood-berry", "-o", output, "--experiments", "3", "--seed", "7", "--jobs", "2", "--store",
             "all", "--audit", "0.01", "--quiet", "--parallel", "processes", "--shard-interval", "0.5"});
  CHECK(result.message.empty());
  REQUIRE(result.code == ExitCode::done);
  const Campaign campaign = read_archive(output);
  CHECK(campaign.study.seed == 7);
  CHECK(campaign.info.jobs == 2);
  CHECK(campaign.info.solver == "auto");
  CHECK(campaign.info.audit_share == 0.01);
  CHECK_FALSE(campaign.audit.empty());
  REQUIRE(campaign.records.size() == 3);
  for (const ExperimentRecord& record : campaign.records)
    CHECK(record.loop.has_value());
  CHECK_THAT(campaign.info.command, Contains("mpmbench run wood-berry -o '" + output + "' --experiments 3"));

  CHECK(method_names(campaign) == std::vector<std::string>{"botelho"});
  for (const CampaignMethod& method : campaign.methods)
    CHECK(method.command == campaign.info.command);

  const Words run{"run", "wood-berry", "-o", output, "--experiments", "1", "--quiet"};
  REQUIRE(typed(run + Words{"--methods", "sse,botelho", "--overwrite"}).code == ExitCode::done);
  CHECK(method_names(read_archive(output)) == std::vector<std::string>{"sse", "botelho"});
  CHECK(read_archive(output).study.methods == std::vector<std::string>{"sse", "botelho"});
  CHECK_THAT(complaint(run + Words{"--methods", "sse,ssf"}), Contains("--methods: found 'ssf'"));
  CHECK_THAT(complaint(run + Words{"--solver", "ipopt", "--parallel", "threads"}),
             Contains("found threads for the solver ipopt"));
  REQUIRE(typed(run + Words{"--solver", "active-set", "--store", "none"}).code == ExitCode::done);
  CHECK(read_archive(output).info.solver == "active-set");
  CHECK_FALSE(read_archive(output).records.front().loop.has_value());
}

TEST_CASE("command line: run takes changes of its study, which its archive has") {
  const TemporaryFolder folder;
  const std::string output = folder / "a.h5";
  const Words run{"run", "wood-berry", "-o", output, "--experiments", "1", "--quiet"};
  REQUIRE(typed(run + Words{"--set", "simulation.samples=150", "--set", "disturbance.sequence=\"shared\""})
              .code == ExitCode::done);
  const Study study = read_archive(output).study;
  CHECK(study.simulation.samples == 150);
  CHECK(study.disturbance.sequence == SignalSequence::shared);
  CHECK_THAT(complaint(run), Contains("with a different study text"));
  CHECK_THAT(complaint(run + Words{"--set", "simulation.sample=150"}), Contains("nearest: 'samples'"));
  CHECK_THAT(complaint(run + Words{"--set", "simulation.samples"}), Contains("--set"));
  CHECK_THAT(complaint({"show", "wood-bery"}), Contains("nearest: 'wood-berry'"));
}

TEST_CASE("command line: what is to become of an interrupted run") {
  const TemporaryFolder folder;
  const fs::path output = folder / "a.h5";
  const Words run{"run", "wood-berry", "-o",         output,   "--experiments",
                  "1",   "--solver",   "active-set", "--quiet"};
  const auto leave_shard = [&] {
    fs::create_directory(folder / "a.h5.shards");
    make_file(folder / "a.h5.shards" / "00000001.shard", "damaged");
  };
  leave_shard();
  CHECK_THAT(complaint(run), Contains("--resume") && Contains("--discard"));
  CHECK_FALSE(fs::exists(output));
  CHECK_THAT(complaint(run + Words{"--resume", "--discard"}), Contains("excludes"));
  for (const char* choice : {"--resume", "--discard"}) {
    leave_shard();
    CHECK(typed(run + Words{choice}).code == ExitCode::done);
    CHECK(fs::exists(output));
    CHECK_FALSE(fs::exists(folder / "a.h5.shards"));
  }
}

TEST_CASE("command line: an unhealthy basis case stops a run, unless it is allowed") {
  const TemporaryFolder folder;
  const std::string seed =
      std::to_string(find_study("wood-berry").seed + 1);  // its noise spoils the basis case
  const Words run{"run",    "wood-berry", "-o",       folder / "a.h5", "--experiments", "1",
                  "--seed", seed,         "--solver", "active-set",    "--quiet"};
  CHECK_THAT(complaint(run), Contains("self-check"));
  CHECK(typed(run + Words{"--allow-unhealthy-basis"}).code == ExitCode::done);
}

TEST_CASE("command line: reproduce takes several changes, one word each") {
  CHECK_THAT(complaint({"reproduce", "--set", "a.b=1", "2.5"}), Contains("unknown key 'a'"));
  const std::string change = "study.seed=3";
  CHECK_THAT(complaint({"reproduce", "--set", change, "--set", "c=[1, 2]", "2.5"}),
             Contains("unknown key 'c'"));
  CHECK_THAT(complaint({"reproduce", "--set", change, "99.9", "--seeds", "7"}), Contains("found '99.9'"));
}

TEST_CASE("command line: an archive that is none is wrong input, whatever was to be done with it") {
  const TemporaryFolder folder;
  const std::string none = folder / "none.h5";
  for (const Words& words : std::vector<Words>{{"replay", none, "1"},
                                               {"summary", none, "--json"},
                                               {"check", none, "--gates", "g.toml", "--junit", "j.xml"},
                                               {"report", none, "--figures", folder / "f", "--format", "pdf"},
                                               {"plot", none, "12", "-o", folder / "x.png"},
                                               {"compare", none, "--methods", "botelho,sse"},
                                               {"export", none, "--table", "loops", "-o", folder / "x.csv"}})
    CHECK_THAT(complaint(words), Contains("mpmbench: " + none + ": no such file"));
  CHECK_THAT(complaint({"plot", none, "12", "-o", "x.gif"}), Contains("x.gif"));
}

TEST_CASE("command line: export writes the table that is asked for") {
  const TemporaryFolder folder;
  const Campaign campaign = made_up_campaign();
  write_archive(folder / "a.h5", campaign, findings_of(campaign));
  const Words words{"export", folder / "a.h5", "-o", folder / "t.csv", "--table"};
  for (const std::string& table : csv_table_names(campaign)) {
    REQUIRE(typed(words + Words{table}).code == ExitCode::done);
    CHECK(file_content(folder / "t.csv") == csv_table(campaign, table));
  }
  CHECK_THAT(complaint(words + Words{"trajectories"}),
             Contains("--table: found 'trajectories'; allowed: experiments"));
}

TEST_CASE("command line: what cannot be written is no wrong input") {
  const TemporaryFolder folder;
  const CommandResult result = typed({"run", "wood-berry", "-o", folder / "none" / "a.h5"});
  CHECK(result.code == ExitCode::not_finished);
  CHECK_THAT(result.message, Contains("mpmbench: ") && Contains("does not exist"));
}

TEST_CASE("command line: wrong usage names what is wrong") {
  const Words run{"run", "chapter6", "-o", "x"};
  const std::vector<std::pair<Words, std::string>> wrong{
      {{}, "Test methods on simulated loops"},
      {{"dance"}, "command: found 'dance'; allowed: init, validate, run"},
      {{"--verson"}, "option: found '--verson' (nearest: '--version'); allowed: those of `mpmbench --help`"},
      {{"sumary", "--help"}, "command: found 'sumary' (nearest: 'summary')"},
      {{"run", "chapter6"}, "mpmbench: --output: found nothing; allowed: Archive to write"},
      {{"run", "chapter6", "--experimets", "4"}, "option: found '--experimets' (nearest: '--experiments')"},
      {{"run", "chapter6", "extra", "-o", "x"}, "argument: found 'extra'"},
      {run + Words{"--jobs", "0"}, "--jobs"},
      {run + Words{"--experiments", "-4"}, "--experiments"},
      {run + Words{"--methods"}, "--methods: found nothing; allowed: Methods"},
      {run + Words{"--solver", "ipop"}, "--solver: found 'ipop' (nearest: 'ipopt'); allowed: auto, "},
      {run + Words{"--audit", "2"}, "--audit"},
      {run + Words{"--parallel", "both"}, "--parallel"},
      {run + Words{"--store", "some"}, "--store"},
      {run + Words{"--shard-interval", "-1"}, "--shard-interval"},
      {run + Words{"--shard-interval", "nan"}, "found nan; allowed: a number from 0 to"},
      {run + Words{"--audit", "nan"}, "--audit"},
      {run + Words{"--experiments", "0"}, "found 0; allowed: a whole number from 1 to 1000000000"},
      {run + Words{"--seed", "-1"}, "found -1; allowed: a whole number from 0 to 18446744073709551615"},
      {run + Words{"--seed", "18446744073709551616"}, "found 18446744073709551616"},
      {run + Words{"--seed", "010"}, "found 010"},
      {run + Words{"-o", ""}, "--output"},
      {run + Words{"--shard", ""}, "--shard: found nothing"},
      {run + Words{"--range", ""}, "--range: found nothing"},
      {{"reproduce", "2.5", "-o", "x", "--shard", ""}, "--shard: found nothing"},
      {{"assess", "wood-berry", "x.csv", "--window", "010"}, "found 010"},
      {{"repair", "x.h5", "--index", "010"}, "found 010"},
      {{"init", "x.toml", "--sample-time", "0x1p3"}, "found 0x1p3; allowed: a number > 0"},
      {{"init", "x.toml", "--sample-time", "inf"}, "found inf; allowed: a number > 0"},
      {{"suite", "quick", "-o", "x", "--seed", "0x10"}, "found 0x10"},
      {{"validate", "chapter6", "--seed", "1e3"}, "found 1e3"},
      {{"sweep", "chapter6"}, "--output: found nothing"},
      {{"sweep", "chapter6", "-o", "x", "--seed", "3"}, "--seed"},
      {{"reproduce", "2.5", "--seeds", "0"}, "--seeds"},
      {{"reproduce", "2.5", "--set"}, "--set"},
      {{"check", "x.h5"}, "--gates: found nothing; allowed: "},
      {{"replay", "x.h5", "-1"}, "INDEX"},
      {{"report", "x.h5", "--figure", "f"}, "found '--figure' (nearest: '--figures')"},
      {{"report", "x.h5"}, "At least 1 option from [-o,--output,--figures]"},
      {{"report", "x.h5", "-o", "y", "--format", "pdf"}, "--format requires --figures"},
      {{"report", "x.h5", "--figures", "f", "--format", "gif"}, "--format"},
      {{"plot", "x.h5", "3"}, "--output: found nothing"},
      {{"plot", "x.h5", "-3", "-o", "x.svg"}, "INDEX"}};
  for (const auto& [words, name] : wrong)
    CHECK_THAT(complaint(words), Contains(name));
}

TEST_CASE("command line: help names every command, and the defaults of each") {
  const CommandResult help = typed({"--help"});
  CHECK(help.code == ExitCode::done);
  for (const char* name : {"run", "replay", "summary", "sweep", "check", "report", "plot", "compare",
                           "export", "reproduce", "list", "methods"}) {
    CHECK_THAT(help.message, Contains(std::string("\n  ") + name + " "));
    CHECK(typed({name, "--help"}).code == ExitCode::done);
  }
  CHECK_THAT(help.message, Contains("Exit codes: 0 done, 1 "));
  CHECK_THAT(typed({"run", "--help"}).message, !Contains("->"));
  CHECK_THAT(typed({"run", "--help"}).message,
             Contains("}=auto") && Contains("0 to 1=0.001") && Contains("}=flagged"));
  CHECK_THAT(typed({"--version"}).message, Contains("mpmbench"));
}

}  // namespace
