#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "analysis/experiment/experiment.hpp"
#include "bench/campaign_runner.hpp"

namespace mpm {

/// `mpmbench run STUDY -o OUT ...`
struct RunCommand {
  std::string study;
  std::string output;
  std::optional<std::int64_t> experiments;
  std::optional<std::uint64_t> seed;
  int jobs = 1;
  std::string solver = "auto";
  Parallel parallel = Parallel::by_solver;
  double audit_share = 0.001;
  StorePolicy store = StorePolicy::flagged;
  bool allow_unhealthy_basis = false;
  Leftovers leftovers = Leftovers::refuse;  ///< --resume, --discard
  double shard_interval = 2.0;              ///< s
  bool quiet = false;
};

/// `mpmbench replay ARCHIVE INDEX`
struct ReplayCommand {
  std::string archive;
  std::int64_t index = 0;
};

/// `mpmbench summary ARCHIVE [--json]`
struct SummaryCommand {
  std::string archive;
  bool json = false;
};

/// `mpmbench sweep SWEEP -o FOLDER`
struct SweepCommand {
  std::string sweep;
  std::string output;
  std::optional<std::int64_t> experiments;
  int jobs = 1;
  std::string solver = "auto";
  bool quiet = false;
};

/// `mpmbench check ARCHIVE --gates FILE [--junit FILE]`
struct CheckCommand {
  std::string archive;
  std::string gates;
  std::string junit;  ///< file to write; none when empty
};

/// `mpmbench report ARCHIVE [-o OUT.html] [--figures DIR [--format svg|pdf|png]]`
struct ReportCommand {
  std::string archive;
  std::string output;   ///< no page when empty
  std::string figures;  ///< folder; no figures as files when empty
  std::string format = "svg";
};

/// `mpmbench plot ARCHIVE INDEX -o FILE`
struct PlotCommand {
  std::string archive;
  std::int64_t index = 0;
  std::string output;  ///< its extension names the format
};

/// `mpmbench compare ARCHIVE [--methods A,B,...] [-o OUT.h5] [--json]`
struct CompareCommand {
  std::string archive;
  std::vector<std::string> methods;  ///< names of assessment_methods()
  std::string output;                ///< archive with the comparison; none when empty
  std::optional<std::int64_t> experiments;
  int jobs = 1;
  bool json = false;
  bool quiet = false;
};

/// `mpmbench reproduce [TABLES] [--set KEY=VALUE]... [--seeds N] [--json] [-o PAGE.html]`
struct ReproduceCommand {
  std::string tables = "all";
  std::string output;  ///< no page when empty
  std::string solver = "active-set";
  bool json = false;
  std::vector<std::string> changes;  ///< --set, each KEY=VALUE
  std::optional<int> seeds;          ///< none: each table once, with the seeds of its studies
  int jobs = 1;
};

/// `mpmbench list`
struct ListCommand {};

/// Nothing to run: the text is for stdout (help, version) or stderr (wrong usage) and the code is the exit
/// code.
struct UsageText {
  std::string text;
  int exit_code;
};

using Command =
    std::variant<RunCommand, ReplayCommand, SummaryCommand, CheckCommand, SweepCommand, ReportCommand,
                 PlotCommand, CompareCommand, ReproduceCommand, ListCommand, UsageText>;

/// Reads the command line; wrong usage gives UsageText with exit code 2.
Command parse_command_line(int argc, const char* const* argv);

}  // namespace mpm
