#include "results/plot/figure_format.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"

namespace mpm {
namespace {

constexpr auto kFormats = enumerators<FigureFormat>();

}  // namespace

const std::vector<std::string>& figure_format_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const FigureFormat format : kFormats)
      list.emplace_back(to_string(format));
    return list;
  }();
  return names;
}

FigureFormat figure_format(const std::string& name) {
  for (const FigureFormat format : kFormats)
    if (name == to_string(format))
      return format;
  throw InputError("format of a figure", "'" + name + "'",
                   fmt::format("{}", fmt::join(figure_format_names(), ", ")));
}

FigureFormat figure_format_of(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  for (const FigureFormat format : kFormats)
    if (extension == fmt::format(".{}", to_string(format)))
      return format;
  throw InputError("file of a figure", fmt::format("'{}'", file.string()),
                   fmt::format("a name that ends in .{}", fmt::join(figure_format_names(), ", .")));
}

}  // namespace mpm
