#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/enum_words.hpp"

namespace mpm {

/// The formats in which a figure can be written.
enum class FigureFormat { svg, pdf, png };

template <>
inline constexpr auto kWords<FigureFormat> = word_list("svg", "pdf", "png");

/// The names of the formats, for help texts and messages.
const std::vector<std::string>& figure_format_names();

/// Returns the format of this name. Throws InputError, which lists the known names, if there is none.
FigureFormat figure_format(const std::string& name);

/// Returns the format that the extension of a file stands for. Throws InputError as above.
FigureFormat figure_format_of(const std::filesystem::path& file);

}  // namespace mpm
