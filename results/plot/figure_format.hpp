#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace mpm {

/// The formats in which a figure can be written.
enum class FigureFormat { svg, pdf, png };

std::string_view to_string(FigureFormat format);

/// Their names, for help texts and messages.
const std::vector<std::string>& figure_format_names();

/// The format of this name. Throws InputError, which lists the known ones, for another.
FigureFormat figure_format(const std::string& name);

/// The format that the extension of this file stands for. Throws InputError as above.
FigureFormat figure_format_of(const std::filesystem::path& file);

}  // namespace mpm
