#include "bench/campaign/part_merge.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "bench/campaign/calibration_runs.hpp"
#include "bench/campaign/campaign_steps.hpp"
#include "bench/campaign/comparison_runner.hpp"
#include "bench/campaign/streamed_records.hpp"
#include "bench/shards/shard_folder.hpp"
#include "bench/shards/shard_identity.hpp"
#include "scenarios/loop/calibration.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

void require_same_campaign(const PartFolder& part, const PartFolder& first) {
  require_same(shard_identity(part.study, part.options), shard_identity(first.study, first.options),
               part.path.string());
}

/// Those of a campaign with as many loops as the whole one, in pieces of one number.
bool are_pieces(const std::vector<PartFolder>& parts, std::int64_t loops) {
  return !parts.empty() && std::all_of(parts.begin(), parts.end(), [&](const PartFolder& part) {
    return part.loops == loops && part.part.shard->of == parts.front().part.shard->of;
  });
}

}  // namespace

std::string MissingPieces::array() const {
  std::string text;
  for (const LoopRange& range : ranges_of(numbers)) {
    text += fmt::format("{}{}", text.empty() ? "" : ",", range.first);
    if (range.end > range.first + 1)
      text += fmt::format("-{}", range.end - 1);
  }
  return text;
}

/// A run that is finished packs its shards: each of the few large ones is there before the small ones go, so
/// that another look finds all of it, and that soon.
PartMerge::PartMerge(const std::vector<std::string>& folders, const ShardSet::Warn& warn) {
  constexpr int kMostLooks = 50;
  constexpr std::chrono::milliseconds kPause{100};
  for (int look = 1;; ++look) {
    std::vector<std::string> warnings;  // of this look
    try {
      take_stock(folders, [&warnings](const std::string& text) { warnings.push_back(text); });
      std::for_each(warnings.begin(), warnings.end(), warn);
      return;
    } catch (const ShardGone&) {
      if (look == kMostLooks)
        throw;
      std::this_thread::sleep_for(kPause);
    }
  }
}

void PartMerge::take_stock(const std::vector<std::string>& folders, const ShardSet::Warn& warn) {
  part_count_ = 0;
  pieces_.clear();
  std::vector<fs::path> shards, calibration_shards;
  for (const fs::path& folder : find_parts(folders)) {
    take_part(folder);
    for (fs::path& shard : shards_in(folder))
      shards.push_back(std::move(shard));
    for (fs::path& shard : shards_in(calibration_shard_folder(folder)))
      calibration_shards.push_back(std::move(shard));
  }
  experiments_.emplace(first_.options, first_.study, experiments());
  experiments_->take_stock(shards, warn);
  if (!first_.study.calibration)
    return;
  calibration_study_ = calibration_study(first_.study);
  calibration_.emplace(calibration_options(first_.options), calibration_study_, loops() - experiments());
  calibration_->take_stock(calibration_shards, warn);
}

void PartMerge::take_part(const fs::path& folder) {
  PartFolder part = read_part(folder);
  if (part_count_++ > 0)
    require_same_campaign(part, first_);
  if (part.part.shard)
    pieces_.push_back(part);
  if (part_count_ == 1 || *part.options.experiments > experiments())
    first_ = std::move(part);
}

LoopRanges PartMerge::missing() const {
  std::vector<std::int64_t> indices = experiments_->missing();
  if (calibration_)
    for (const std::int64_t index : calibration_->missing())
      indices.push_back(experiments() + index);
  return ranges_of(indices);
}

std::optional<MissingPieces> PartMerge::missing_pieces() const {
  if (!are_pieces(pieces_, loops()))
    return std::nullopt;
  MissingPieces pieces;
  pieces.of = pieces_.front().part.shard->of;
  const LoopRanges all{{0, loops()}}, missing = this->missing();
  for (std::int64_t number = 1; number <= pieces.of; ++number) {
    const LoopRanges piece = piece_of(all, number, pieces.of);
    if (std::any_of(missing.begin(), missing.end(), [&](const LoopRange& range) {
          return !piece.empty() && range.first < piece.back().end && range.end > piece.front().first;
        }))
      pieces.numbers.push_back(number);
  }
  return pieces;
}

std::int64_t PartMerge::experiments_done() const {
  return experiments() - std::ssize(experiments_->missing());
}

Campaign PartMerge::merge(const CampaignHooks& hooks) const {
  const auto start = std::chrono::steady_clock::now();
  Campaign campaign;
  campaign.study = first_.study;
  campaign.basis = checked_basis(campaign.study, first_.options, hooks, {loops(), loops()});
  campaign.info = info_of(campaign.study, first_.options);
  campaign.methods = methods_of(campaign.study, "");
  take_records(campaign, *experiments_, hooks.stop);
  campaign.info.seconds = experiments_->seconds();
  if (calibration_ && calibration_->missing().empty()) {
    campaign.calibration = calibration_of(calibration_study_, records_in(*calibration_, hooks.stop));
    campaign.info.seconds += calibration_->seconds();
  }
  campaign.info.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return campaign;
}

}  // namespace mpm
