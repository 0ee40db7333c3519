#include "results/blind/loop_store.hpp"

#include <cassert>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "plants/non_finite.hpp"
#include "results/files/archive_error.hpp"

namespace mpm {
namespace {

std::size_t rows_of(const Study& study, const LoopSignal& signal) {
  return row_names(study, signal).size();
}

std::size_t values_of(const Study& study, const LoopSignal& signal) {
  return rows_of(study, signal) * static_cast<std::size_t>(study.simulation.samples);
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

LoopStore::LoopStore(std::filesystem::path folder, const Study& study, std::size_t count)
    : folder_(std::move(folder)), study_(study), count_(count) {
  for (const LoopSignal& signal : loop_signals())
    values_ += values_of(study_, signal);
  const std::filesystem::path path = folder_ / fmt::format(".loops-{}", ::getpid());
  file_.open(path, std::ios::in | std::ios::out | std::ios::trunc | std::ios::binary);
  require("make a file in it");
  std::error_code stays;
  std::filesystem::remove(path, stays);  // what is open stays until it is closed, whatever ends this process
}

void LoopStore::put(std::size_t number, const AssessedLoop& loop) {
  std::vector<double> values;
  values.reserve(values_);
  for (const LoopSignal& signal : loop_signals()) {
    const Eigen::MatrixXd& of_loop = loop.*signal.member;
    if (loop.samples() > 0)
      values.insert(values.end(), of_loop.data(), of_loop.data() + of_loop.size());
    else
      values.insert(values.end(), values_of(study_, signal), kNaN);
  }
  assert(values.size() == values_);
  seek(number, 0);
  file_.write(reinterpret_cast<const char*>(values.data()),
              static_cast<std::streamsize>(values_ * sizeof(double)));
  require("keep loops in it");
}

Eigen::MatrixXd LoopStore::signal(std::size_t number, const LoopSignal& signal) {
  std::size_t before = 0;
  for (const LoopSignal& other : loop_signals()) {
    if (other.member == signal.member)
      break;
    before += values_of(study_, other);
  }
  Eigen::MatrixXd values(static_cast<Eigen::Index>(rows_of(study_, signal)), study_.simulation.samples);
  seek(number, before);
  file_.read(reinterpret_cast<char*>(values.data()),
             static_cast<std::streamsize>(static_cast<std::size_t>(values.size()) * sizeof(double)));
  require("read the loops that it keeps");
  return values;
}

AssessedLoop LoopStore::loop(std::size_t number) {
  AssessedLoop loop;
  for (const LoopSignal& each : loop_signals())
    loop.*each.member = signal(number, each);
  return loop;
}

void LoopStore::seek(std::size_t number, std::size_t value) {
  const auto place = static_cast<std::streamoff>((number * values_ + value) * sizeof(double));
  file_.seekg(place);  // of what is written, too
}

void LoopStore::require(const char* action) const {
  if (!file_)
    throw ArchiveError(fmt::format("{}: cannot {}: {}", folder_.string(), action, std::strerror(errno)));
}

}  // namespace mpm
