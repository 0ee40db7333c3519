#include "plants/outside/fmu_description.hpp"

#include <cctype>
#include <charconv>
#include <cstddef>
#include <iterator>
#include <limits>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pugixml.hpp>

#include "base/error.hpp"
#include "base/system/foreign_text.hpp"
#include "plants/outside/fmi3.hpp"

namespace mpm {
namespace {

constexpr const char* kDescriptionFile = "modelDescription.xml";
constexpr std::size_t kMostNames = 20;    // in a message
constexpr std::size_t kShownOfXml = 100;  // bytes of a text, in a message

std::string attribute_of(const pugi::xml_node& node, const char* name, const std::string& file) {
  const pugi::xml_attribute attribute = node.attribute(name);
  if (!attribute || *attribute.value() == '\0')
    throw InputError(fmt::format("{}: {}: {} of {}", file, kDescriptionFile, name, node.name()), "nothing",
                     "a text");
  return attribute.value();
}

const char* real_of(FmiVersion version) {
  return version == FmiVersion::two ? "Real" : "Float64";
}

/// Returns the type of a variable: by FMI 2.0 the name of a child element, by FMI 3.0 that of the element
/// itself.
std::string type_of(const pugi::xml_node& variable, FmiVersion version) {
  if (version == FmiVersion::three)
    return fmt::format("{}{}", variable.name(), variable.child("Dimension") ? " array" : "");
  for (const char* type : {"Real", "Integer", "Boolean", "String", "Enumeration"})
    if (variable.child(type))
      return type;
  return "no type";
}

/// Reads a value reference, which must be a number that fits, of digits only.
fmi2::ValueReference reference_of(const pugi::xml_node& node, const std::string& file) {
  const std::string text = node.attribute("valueReference").value();
  fmi2::ValueReference reference = 0;
  const char* const end = text.data() + text.size();
  if (const auto read = std::from_chars(text.data(), end, reference);
      text.empty() || read.ec != std::errc() || read.ptr != end)
    throw InputError(
        fmt::format("{}: {}: valueReference of '{}'", file, kDescriptionFile,
                    foreign_text(node.attribute("name").value(), kShownOfXml)),
        text.empty() ? "nothing" : fmt::format("'{}'", foreign_text(text, kShownOfXml)),
        fmt::format("a whole number from 0 to {}", std::numeric_limits<fmi2::ValueReference>::max()));
  return reference;
}

/// Returns the name of the library. It must be a name of C, so that it cannot be a path.
std::string identifier_of(const pugi::xml_node& kind, const std::string& file) {
  constexpr std::size_t kLongest = 200;
  std::string identifier = attribute_of(kind, "modelIdentifier", file);
  if (identifier.size() > kLongest || std::isdigit(static_cast<unsigned char>(identifier.front())) != 0 ||
      identifier.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_") !=
          std::string::npos)
    throw InputError(fmt::format("{}: {}: modelIdentifier", file, kDescriptionFile),
                     fmt::format("'{}'", foreign_text(identifier, kShownOfXml)),
                     fmt::format("a name of C with at most {} characters", kLongest));
  return identifier;
}

FmuVariable read_variable(const pugi::xml_node& node, FmiVersion version, const std::string& file) {
  return {.reference = reference_of(node, file),
          .type = type_of(node, version),
          .causality = node.attribute("causality").as_string("local"),
          .variability = node.attribute("variability").as_string("continuous")};
}

std::size_t count_of(const pugi::xml_node& unknowns) {
  const auto each = unknowns.children("Unknown");
  return static_cast<std::size_t>(std::distance(each.begin(), each.end()));
}

bool fits(const FmuVariable& variable, FmuRole role) {
  switch (role) {
    case FmuRole::input:
      return variable.causality == "input";
    case FmuRole::output:
      return variable.causality == "output" || variable.causality == "local";
    case FmuRole::parameter:
      return variable.causality == "parameter";
  }
  return false;
}

std::string_view causality_of(FmuRole role) {
  return role == FmuRole::input ? "input" : role == FmuRole::output ? "output" : "parameter";
}

/// Lists some names that the study could have meant; for outputs, only those that are declared as outputs.
std::string names_of(const FmuDescription& description, FmuRole role) {
  std::vector<std::string> names;
  for (const auto& [name, variable] : description.variables)
    if (variable.causality == causality_of(role) && variable.type == real_of(description.version))
      names.push_back(name);
  const bool all = names.size() <= kMostNames;
  if (!all)
    names.resize(kMostNames);
  return names.empty() ? fmt::format("a {} {}; {} has none", real_of(description.version), causality_of(role),
                                     description.file)
                       : fmt::format("{}{}", fmt::join(names, ", "), all ? "" : ", ...");
}

}  // namespace

const FmuVariable& FmuDescription::variable(std::string_view name, FmuRole role,
                                            const std::string& place) const {
  const auto found = variables.find(name);
  if (found == variables.end())
    throw InputError(place, fmt::format("'{}', which {} has not", name, file), names_of(*this, role));
  const FmuVariable& variable = found->second;
  if (!fits(variable, role))
    throw InputError(place, fmt::format("'{}' of causality {}", name, variable.causality),
                     names_of(*this, role));
  if (variable.type != real_of(version))
    throw InputError(place, fmt::format("'{}' of type {}", name, variable.type), names_of(*this, role));
  return variable;
}

FmuDescription parse_fmu_description(const std::string& xml, const std::string& file) {
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(xml.data(), xml.size());
  if (!parsed)
    throw InputError(fmt::format("{}: {}", file, kDescriptionFile),
                     fmt::format("{} at byte {}", parsed.description(), parsed.offset), "XML");
  const pugi::xml_node root = document.child("fmiModelDescription");
  if (!root)
    throw InputError(fmt::format("{}: {}", file, kDescriptionFile), "no element fmiModelDescription",
                     "the description of an FMU");
  const std::string written = root.attribute("fmiVersion").value();
  if (written != fmi2::kVersion && written != fmi3::kVersion)
    throw InputError(fmt::format("{}: {}: fmiVersion", file, kDescriptionFile),
                     written.empty() ? "nothing" : fmt::format("'{}'", foreign_text(written, kShownOfXml)),
                     fmt::format("'{}' or '{}'", fmi2::kVersion, fmi3::kVersion));
  const FmiVersion version = written == fmi2::kVersion ? FmiVersion::two : FmiVersion::three;
  pugi::xml_node kind = root.child("CoSimulation");
  const bool integrates = kind;
  if (!integrates)
    kind = root.child("ModelExchange");
  if (!kind)
    throw InputError(fmt::format("{}: kind of the FMU", file), "neither",
                     "co-simulation or model exchange; export it as such");
  FmuDescription description{
      .file = file,
      .version = version,
      .kind = integrates ? FmuKind::co_simulation : FmuKind::model_exchange,
      .guid = attribute_of(root, version == FmiVersion::two ? "guid" : "instantiationToken", file),
      .identifier = identifier_of(kind, file),
      .states = count_of(root.child("ModelStructure").child("Derivatives")),
      .indicators = root.attribute("numberOfEventIndicators").as_uint(),
      .variables = {}};
  for (const pugi::xml_node& node : root.child("ModelVariables"))
    if (node.type() == pugi::node_element &&
        (version == FmiVersion::three || std::string_view(node.name()) == "ScalarVariable")) {
      const FmuVariable variable = read_variable(node, version, file);
      description.variables.emplace(attribute_of(node, "name", file), variable);
      for (const pugi::xml_node& alias : node.children("Alias"))
        description.variables.emplace(attribute_of(alias, "name", file), variable);
    }
  return description;
}

}  // namespace mpm
