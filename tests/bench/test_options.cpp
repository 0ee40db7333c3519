#include <vector>

#include <catch2/catch.hpp>

#include "bench/options.hpp"

namespace {

using namespace mpm;

Command parse(std::vector<const char*> words) {
  words.insert(words.begin(), "mpmbench");
  return parse_command_line(static_cast<int>(words.size()), words.data());
}

TEST_CASE("options: run with everything") {
  const Command command = parse({"run",        "chapter6",  "-o",      "x.h5",   "--experiments",
                                 "40",         "--seed",    "7",       "--jobs", "3",
                                 "--solver",   "ipopt",     "--store", "all",    "--quiet",
                                 "--parallel", "processes", "--audit", "0.25",   "--shard-interval",
                                 "0.5"});
  const RunCommand& run = std::get<RunCommand>(command);
  CHECK(run.study == "chapter6");
  CHECK(run.experiments == 40);
  CHECK(run.seed == 7);
  CHECK(run.jobs == 3);
  CHECK(run.store == StorePolicy::all);
  CHECK(run.quiet);
  CHECK(run.solver == "ipopt");
  CHECK(run.parallel == Parallel::processes);
  CHECK(run.audit_share == 0.25);
  CHECK(run.shard_interval == 0.5);
}

TEST_CASE("options: what is to become of an interrupted run") {
  const auto leftovers = [](std::vector<const char*> more) {
    more.insert(more.begin(), {"run", "chapter6", "-o", "x.h5"});
    return std::get<RunCommand>(parse(more)).leftovers;
  };
  CHECK(leftovers({}) == Leftovers::refuse);
  CHECK(leftovers({"--resume"}) == Leftovers::resume);
  CHECK(leftovers({"--discard"}) == Leftovers::discard);
}

TEST_CASE("options: check takes a gate file, and a JUnit file when there is to be one") {
  const Command with_junit = parse({"check", "x.h5", "--gates", "g.toml", "--junit", "j.xml"});
  CHECK(std::get<CheckCommand>(with_junit).archive == "x.h5");
  CHECK(std::get<CheckCommand>(with_junit).gates == "g.toml");
  CHECK(std::get<CheckCommand>(with_junit).junit == "j.xml");
  const Command without = parse({"check", "x.h5", "--gates", "g.toml"});
  CHECK(std::get<CheckCommand>(without).junit.empty());
}

TEST_CASE("options: report and plot") {
  const Command command = parse({"report", "x.h5", "-o", "x.html", "--figures", "f", "--format", "pdf"});
  const ReportCommand& report = std::get<ReportCommand>(command);
  CHECK(report.archive == "x.h5");
  CHECK(report.output == "x.html");
  CHECK(report.figures == "f");
  CHECK(report.format == "pdf");
  CHECK(std::get<ReportCommand>(parse({"report", "x.h5", "--figures", "f"})).format == "svg");
  const Command other = parse({"plot", "x.h5", "12", "-o", "x.png"});
  CHECK(std::get<PlotCommand>(other).index == 12);
  CHECK(std::get<PlotCommand>(other).output == "x.png");
}

TEST_CASE("options: reproduce with changes and seeds") {
  const Command command =
      parse({"reproduce", "--set", "a.b=1", "--set", "c=[1, 2]", "2.5", "--seeds", "7", "--jobs", "3"});
  const ReproduceCommand& reproduce = std::get<ReproduceCommand>(command);
  CHECK(reproduce.changes == std::vector<std::string>{"a.b=1", "c=[1, 2]"});
  CHECK(reproduce.tables == "2.5");
  CHECK(reproduce.seeds == 7);
  CHECK(reproduce.jobs == 3);
  CHECK_FALSE(std::get<ReproduceCommand>(parse({"reproduce"})).seeds);
}

TEST_CASE("options: wrong usage has exit code 2, help has 0") {
  const std::vector<std::vector<const char*>> wrong{{},
                                                    {"dance"},
                                                    {"run", "chapter6"},
                                                    {"run", "chapter6", "-o", "x", "--jobs", "0"},
                                                    {"run", "chapter6", "-o", "x", "--experiments", "-4"},
                                                    {"run", "chapter6", "-o", "x", "--solver", "none"},
                                                    {"run", "chapter6", "-o", "x", "--audit", "2"},
                                                    {"run", "chapter6", "-o", "x", "--parallel", "both"},
                                                    {"run", "chapter6", "-o", "x", "--resume", "--discard"},
                                                    {"run", "chapter6", "-o", "x", "--shard-interval", "-1"},
                                                    {"sweep", "chapter6"},
                                                    {"reproduce", "2.5", "--seeds", "0"},
                                                    {"reproduce", "2.5", "--set"},
                                                    {"check", "x.h5"},
                                                    {"replay", "x.h5", "-1"},
                                                    {"report", "x.h5"},
                                                    {"report", "x.h5", "-o", "y", "--format", "pdf"},
                                                    {"report", "x.h5", "--figures", "f", "--format", "gif"},
                                                    {"plot", "x.h5", "3"},
                                                    {"plot", "x.h5", "-3", "-o", "x.svg"}};
  for (const auto& words : wrong)
    CHECK(std::get<UsageText>(parse(words)).exit_code == 2);
  CHECK(std::get<UsageText>(parse({"--help"})).exit_code == 0);
  CHECK(std::get<UsageText>(parse({"--version"})).exit_code == 0);
}

}  // namespace
