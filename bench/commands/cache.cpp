#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/cache/cache_folder.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/console/output.hpp"
#include "results/text/number_json.hpp"

namespace mpm {
namespace {

constexpr double kShownMegabyte = 1e6;

struct CacheArguments {
  bool clear = false;
  bool json = false;
};

ExitCode show_cache(const CacheArguments& options) {
  const std::shared_ptr<const CacheFolder> cache = user_cache();
  const CacheUsage usage = !cache ? CacheUsage() : options.clear ? cache->clear() : cache->usage();
  if (options.json) {
    nlohmann::ordered_json json{{"folder", nullptr}, {"files", usage.files}, {"bytes", usage.bytes}};
    if (cache)
      json["folder"] = cache->path().string();
    json["limit"] = cache ? cache->limit() : 0;
    json["cleared"] = options.clear;
    print_result(json_text(json));
  } else if (!cache) {
    print_result("The cache is off.\n");
  } else {
    print_result(fmt::format("{}: {}{} files, {:.1f} MB (at most {:.0f} MB)\n", cache->path().string(),
                             options.clear ? "removed " : "", usage.files,
                             static_cast<double>(usage.bytes) / kShownMegabyte,
                             static_cast<double>(cache->limit()) / kShownMegabyte));
  }
  return ExitCode::done;
}

}  // namespace

void add_cache(CommandSet& commands) {
  const auto options = std::make_shared<CacheArguments>();
  CLI::App& app = commands.add("cache", "Show or clear the cache of loops for the next suite",
                               [options] { return show_cache(*options); });
  app.add_flag("--clear", options->clear, "Remove them all");
  add_json(app, options->json);
}

}  // namespace mpm
