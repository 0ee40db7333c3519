#include "results/blind/blind_loops.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/methods/method_messages.hpp"
#include "base/non_finite.hpp"
#include "base/row_major.hpp"
#include "base/sha256.hpp"
#include "results/archive/dimensions.hpp"
#include "results/archive/row_io.hpp"
#include "results/files/atomic_file.hpp"
#include "results/files/csv_text.hpp"
#include "results/files/file_seal.hpp"
#include "scenarios/random/random_stream.hpp"

namespace mpm {
namespace {

constexpr const char* kBlindFileType = "mpmbench blind loops";

bool is_candidates(const LoopSignal& signal) {
  return std::strcmp(signal.rows, "candidate") == 0;
}

std::string unit_of_rows(const PlantModel& plant, const LoopSignal& signal) {
  const std::string rows = signal.rows;
  return rows == "candidate" ? "1"
                             : common_unit(rows == "cv"   ? plant.cvs
                                           : rows == "mv" ? plant.mvs
                                                          : plant.mds);
}

void append_number(std::string& text, double value) {
  if (value != value)
    text += ",NaN";
  else
    fmt::format_to(std::back_inserter(text), ",{}", value);
}

/// Appends one line per sample, each beginning with `number` (empty if there is only one loop).
void append_samples(std::string& text, const Study& study, const AssessedLoop& loop,
                    const std::string& number) {
  for (Eigen::Index k = 0; k < loop.samples(); ++k) {
    fmt::format_to(std::back_inserter(text), "{}{}", number, k);
    append_number(text, static_cast<double>(k) * study.controller.sample_time);
    for (const LoopSignal& signal : loop_signals())
      for (Eigen::Index row = 0; row < (loop.*signal.member).rows(); ++row)
        append_number(text, (loop.*signal.member)(row, k));
    text += '\n';
  }
}

std::string heading_of_samples(const Study& study, bool with_candidates, const char* first) {
  std::string text = fmt::format("{}sample,time", first);
  for (const LoopSignal& signal : loop_signals())
    if (with_candidates || !is_candidates(signal))
      for (const std::string& name : row_names(study, signal))
        fmt::format_to(std::back_inserter(text), ",{}", csv_field(fmt::format("{}.{}", signal.name, name)));
  return text + "\n";
}

/// Returns the next loop; if it did not run to its end, all its values are missing.
AssessedLoop next_loop(const BlindLoops::Next& next, const Study& study) {
  AssessedLoop loop = next();
  if (loop.samples() == 0)
    for (const LoopSignal& signal : loop_signals())
      loop.*signal.member =
          Eigen::MatrixXd::Constant(std::ssize(row_names(study, signal)), study.simulation.samples, kNaN);
  return loop;
}

void write_blind_csv(const std::filesystem::path& path, const Study& study, const BlindLoops& loops,
                     const std::string& hash) {
  write_text_atomically(path, [&](const TextSink& add) {
    add(hash_line(hash));
    add(heading_of_samples(study, true, "loop,"));
    const BlindLoops::Next next = loops.begin();
    for (std::size_t i = 0; i < loops.count; ++i) {
      std::string text;
      append_samples(text, study, next_loop(next, study), fmt::format("{},", i));
      add(text);
    }
  });
}

std::string benchmark_csv(const Study& study, const AssessedLoop& benchmark) {
  std::string text = heading_of_samples(study, benchmark.candidates.rows() > 0, "");
  append_samples(text, study, benchmark, "");
  return text;
}

/// Returns a form to fill in, with all columns that a verdict on a whole loop can have. After the line of
/// each loop follow the lines of its `windows`.
std::string empty_verdicts(std::size_t loops, std::optional<int> windows, const std::string& hash) {
  std::string text =
      fmt::format("{}loop,{}flagged,score,cv,source,channels,parameter,size,lower,upper,error\n",
                  hash_line(hash), windows ? "window," : "");
  for (std::size_t i = 0; i < loops; ++i) {
    fmt::format_to(std::back_inserter(text), "{},{},,,,,,,,,\n", i, windows ? "," : "");
    for (int window = 0; window < windows.value_or(0); ++window)
      fmt::format_to(std::back_inserter(text), "{},{},,,,,,,,,,\n", i, window);
  }
  return text;
}

Row<AssessedLoop> row_of(const Study& study, const LoopSignal& signal) {
  return matrix_row<AssessedLoop>({signal.name, signal.meaning, unit_of_rows(study.plant, signal)},
                                  {signal.rows, "sample"}, std::ssize(row_names(study, signal)),
                                  study.simulation.samples, signal.member)
      .along("time");
}

/// Writes all signals in one pass, so that each loop is read once.
void write_loops(Hdf5Group& group, const Study& study, const BlindLoops& loops) {
  std::vector<std::pair<const LoopSignal*, Hdf5Rows<double>>> all;
  for (const LoopSignal& signal : loop_signals())
    if (!row_names(study, signal).empty() || !is_candidates(signal))
      all.emplace_back(&signal, group.create_rows<double>(signal.name, {"loop", signal.rows, "sample"},
                                                          attributes<double>(row_of(study, signal))));
  const BlindLoops::Next next = loops.begin();
  for (std::size_t i = 0; i < loops.count; ++i) {
    const AssessedLoop loop = next_loop(next, study);
    for (auto& [signal, rows] : all) {
      const RowMajorMatrix values = loop.*signal->member;
      std::copy(values.data(), values.data() + values.size(), rows.add());
    }
  }
  for (auto& [signal, rows] : all)
    rows.finish();
}

void write_benchmark(Hdf5Group& group, const Study& study, const AssessedLoop& benchmark) {
  for (const LoopSignal& signal : loop_signals())
    if (const Eigen::MatrixXd& values = benchmark.*signal.member; !is_candidates(signal) || values.rows() > 0)
      store_rows<AssessedLoop>(group, {row_of(study, signal)}, benchmark);
}

void write_dimensions(Hdf5Group& group, const Study& study) {
  write_plant_dimensions(group, study.plant);
  write_sample_dimension(group, "sample", "sample number", "time", study, 0, study.simulation.samples);
}

void write_loop_dimension(Hdf5Group& group, std::size_t count) {
  std::vector<std::int32_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0);
  group.write_dimension("loop", numbers,
                        attributes<std::int32_t>({"loop", "number of the loop in this export"}));
}

/// `name` is for messages.
void write_blind_netcdf(const std::filesystem::path& path, const std::string& name, const Study& study,
                        const AssessmentContext& context, const BlindRecords& records,
                        const std::string& hash) {
  const Hdf5File file = Hdf5File::create_at(path, name);
  Hdf5Group root = file.root();
  root.write_attribute("filetype", kBlindFileType);
  root.write_attribute("Conventions", "CF-1.8");
  root.write_attribute("title", fmt::format("Loops of {} without the truth", study.plant.name));
  root.write_attribute("loops_sha256", hash);
  write_loop_dimension(root, records.loops.count);
  write_dimensions(root, study);
  if (study.record.candidates > 0) {
    std::vector<std::int32_t> candidates(static_cast<std::size_t>(study.record.candidates));
    std::iota(candidates.begin(), candidates.end(), 1);
    root.write_dimension("candidate", candidates,
                         attributes<std::int32_t>({"candidate", "number of the logged signal"}));
  }
  write_loops(root, study, records.loops);
  if (records.benchmarks || context.benchmark) {
    Hdf5Group group = root.create_group("benchmark");
    group.write_attribute("title", records.benchmarks
                                       ? "Of the plant of each loop, a period in which nothing was wrong"
                                       : "A period in which nothing was wrong");
    if (records.benchmarks)
      write_loop_dimension(group, records.benchmarks->count);
    write_dimensions(group, study);
    if (records.benchmarks)
      write_loops(group, study, *records.benchmarks);
    else
      write_benchmark(group, study, *context.benchmark);
  }
  file.finish();
}

void write_blind_text(const std::filesystem::path& path, const std::string& text) {
  write_file_atomically(path, std::as_bytes(std::span(text)));
}

}  // namespace

std::vector<std::string> row_names(const Study& study, const LoopSignal& signal) {
  const std::string rows = signal.rows;
  std::vector<std::string> names;
  if (rows == "candidate")
    for (int i = 0; i < study.record.candidates; ++i)
      names.push_back(fmt::format("{}", i + 1));
  else
    for (const PlantModel::Variable& variable : rows == "cv"   ? study.plant.cvs
                                                : rows == "mv" ? study.plant.mvs
                                                               : study.plant.mds)
      names.push_back(variable.name);
  return names;
}

std::vector<BlindLoop> blind_order(const Campaign& campaign, bool with_calibration) {
  std::vector<BlindLoop> order;
  std::size_t place = 0;
  records_of(campaign).each([&](const ExperimentRecord& record) {
    if (record.status == ExperimentStatus::ok)
      order.push_back({.of_calibration = false, .place = place, .index = record.draw.index});
    ++place;
  });
  for (std::size_t i = 0; with_calibration && i < campaign.calibration.loops.size(); ++i)
    order.push_back({.of_calibration = true, .place = i, .index = static_cast<std::int64_t>(i)});
  RandomStream stream(campaign.study.seed, 0, StreamId::blind_order);
  for (std::size_t left = order.size(); left > 1; --left)
    std::swap(order[left - 1], order[static_cast<std::size_t>(stream.below(left))]);
  return order;
}

std::string loops_hash(const Campaign& campaign, bool with_calibration) {
  Sha256 hash;
  const auto add = [&hash](const std::string& text) { hash.add(std::as_bytes(std::span(text))); };
  add(fmt::format("{}\n{}\n{}\n", campaign.study.source, campaign.study.seed, campaign.info.solver));
  records_of(campaign).each([&](const ExperimentRecord& record) {
    if (record.status != ExperimentStatus::ok)
      return;
    std::string line = fmt::format("{}", record.draw.index);
    for (const double value : record.ivar_basis)
      append_number(line, value);
    add(line + '\n');
  });
  if (with_calibration)
    add(fmt::format("calibration {} {}\n", campaign.calibration.seed, campaign.calibration.loops.size()));
  return hash.digits();
}

std::string hash_line(const std::string& hash) {
  return fmt::format("# mpmbench loops sha256 {}\n", hash);
}

std::string blind_key(const Campaign& campaign, bool with_calibration) {
  std::string text = fmt::format("{}loop,experiment\n", hash_line(loops_hash(campaign, with_calibration)));
  std::size_t number = 0;
  for (const BlindLoop& loop : blind_order(campaign, with_calibration))
    text +=
        loop.of_calibration ? fmt::format("{},\n", number++) : fmt::format("{},{}\n", number++, loop.index);
  return text;
}

void write_blind_loops(const std::filesystem::path& folder, const Campaign& campaign,
                       const AssessmentContext& context, const BlindRecords& records,
                       const BlindParts& parts) {
  const Study& study = campaign.study;
  const std::string hash = loops_hash(campaign, parts.calibration);
  nlohmann::ordered_json description = context_json(context);
  description["loops"] = records.loops.count;
  description["loops_sha256"] = hash;
  std::optional<int> windows;
  if (parts.windows) {
    windows = study.monitoring->count(study.simulation.samples);
    description["monitoring"] = {
        {"window", study.monitoring->window}, {"stride", study.monitoring->stride}, {"windows", *windows}};
  }
  const std::filesystem::path netcdf = folder / "loops.nc";
  write_file_atomically(netcdf, [&](const std::filesystem::path& temporary) {
    write_blind_netcdf(temporary, netcdf.string(), study, context, records, hash);
    seal_file(temporary);
  });
  write_blind_csv(folder / "loops.csv", study, records.loops, hash);
  if (records.benchmarks)
    write_blind_csv(folder / "benchmark.csv", study, *records.benchmarks, hash);
  else if (context.benchmark)
    write_blind_text(folder / "benchmark.csv", benchmark_csv(study, *context.benchmark));
  write_blind_text(folder / "context.json", description.dump(1) + "\n");
  write_blind_text(folder / "verdicts.csv", empty_verdicts(records.loops.count, windows, hash));
}

}  // namespace mpm
