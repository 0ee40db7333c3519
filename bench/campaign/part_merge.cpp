#include "bench/campaign/part_merge.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "bench/campaign/campaign_runner.hpp"
#include "bench/campaign/comparison_runner.hpp"
#include "bench/shards/shard_folder.hpp"
#include "bench/shards/shard_identity.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

void require_same_campaign(const PartFolder& part, const PartFolder& first) {
  require_same(shard_identity(part.study, part.options), shard_identity(first.study, first.options),
               part.path.string());
}

/// Whether these are parts of a campaign of `loops` loops that was split into one number of pieces.
bool are_pieces(const std::vector<PartFolder>& parts, std::int64_t loops) {
  return !parts.empty() && std::all_of(parts.begin(), parts.end(), [&](const PartFolder& part) {
    return part.loops == loops && part.part.number->of == parts.front().part.number->of;
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

/// A run packs its shards when it is finished: it writes the few large ones before it removes the small ones.
/// If a small one is gone, another look soon finds everything.
PartMerge::PartMerge(const std::vector<std::string>& folders, std::shared_ptr<const MethodTable> methods,
                     const ShardStore::Warn& warn)
    : methods_(std::move(methods)) {
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

void PartMerge::take_stock(const std::vector<std::string>& folders, const ShardStore::Warn& warn) {
  part_count_ = 0;
  pieces_.clear();
  const std::vector<fs::path> parts = find_parts(folders);
  for (const fs::path& folder : parts)
    take_part(folder);
  loops_.emplace(first_.study, first_.options);
  store_.emplace(loops_->in_memory());
  for (const fs::path& folder : parts)
    store_->take_stock(shards_in(folder), warn);
}

void PartMerge::take_part(const fs::path& folder) {
  PartFolder part = read_part(folder);
  part.study.assessment.table = methods_;
  if (part_count_++ > 0)
    require_same_campaign(part, first_);
  if (part.part.number)
    pieces_.push_back(part);
  if (part_count_ == 1 || *part.options.experiments > experiments())
    first_ = std::move(part);
}

LoopRanges PartMerge::missing() const {
  return loops_->loops(store_->missing(loops_->keys({{0, loops()}})));
}

std::optional<MissingPieces> PartMerge::missing_pieces() const {
  if (!are_pieces(pieces_, loops()))
    return std::nullopt;
  MissingPieces pieces;
  pieces.of = pieces_.front().part.number->of;
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
  return experiments() - std::ssize(store_->missing(loops_->keys({{0, experiments()}})));
}

Campaign PartMerge::merge(const CampaignHooks& hooks) const {
  const auto start = std::chrono::steady_clock::now();
  Campaign campaign;
  campaign.study = first_.study;
  campaign.basis = checked_basis(campaign.study, first_.options, hooks, loops(), loops());
  campaign.info = info_of(campaign.study, first_.options);
  campaign.methods = methods_of(campaign.study, "");
  loops_->take(campaign, *store_, hooks.stop, false);
  campaign.info.seconds =
      store_->seconds() + std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return campaign;
}

}  // namespace mpm
