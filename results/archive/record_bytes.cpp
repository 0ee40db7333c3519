#include "results/archive/record_bytes.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <type_traits>

#include <fmt/format.h>

#include "results/files/byte_stream.hpp"
#include "scenarios/loop/draw.hpp"

namespace mpm {
namespace {

/// The values of a variable of one record.
template <class T>
std::vector<T> values_of(const RecordVariable& variable, const RecordAccess<T>& access,
                         const ExperimentRecord& record) {
  std::vector<T> values(variable.size());
  access.get(record, values.data());
  return values;
}

/// Their bytes: those of each text after its length, those of all numbers at once.
void write(ByteWriter& writer, const RecordVariable& variable, const ExperimentRecord& record) {
  std::visit(
      [&]<class T>(const RecordAccess<T>& access) {
        const std::vector<T> values = values_of(variable, access, record);
        if constexpr (std::is_same_v<T, std::string>) {
          for (const std::string& text : values)
            transfer(writer, text);
        } else {
          writer.block(values.data(), values.size() * sizeof(T));
        }
      },
      variable.access);
}

void read(ByteReader& reader, const RecordVariable& variable, ExperimentRecord& record) {
  std::visit(
      [&]<class T>(const RecordAccess<T>& access) {
        std::vector<T> values(variable.size());
        if constexpr (std::is_same_v<T, std::string>) {
          for (std::string& text : values)
            transfer(reader, text);
        } else {
          reader.block(values.data(), values.size() * sizeof(T));
        }
        if (const T* const value = value_without_meaning(variable.text, values))
          throw std::runtime_error(
              fmt::format("{} is {}, which is none of its values", variable.text.name, *value));
        access.set(record, values.data());
      },
      variable.access);
}

bool is_in(const RecordTable& table, const ExperimentRecord& record) {
  return !table.has || table.has(record);
}

/// Does the record come from an archive that has not this variable? It then has no number there.
bool is_lacking(const RecordVariable& variable, const ExperimentRecord& record) {
  const auto* const access = std::get_if<RecordAccess<double>>(&variable.access);
  if (!variable.may_lack || access == nullptr)
    return false;
  const std::vector<double> values = values_of(variable, *access, record);
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isnan(value); });
}

std::string bytes_of(const RecordVariable& variable, const ExperimentRecord& record) {
  ByteWriter writer;
  write(writer, variable, record);
  return writer.take();
}

}  // namespace

RecordBytes::RecordBytes(const Study& study, const AssessmentForms& forms)
    : study_(study), tables_(record_tables(study, forms)) {}

std::string RecordBytes::to_bytes(const ExperimentRecord& record) const {
  ByteWriter writer;
  transfer(writer, record.draw.index);
  for (const RecordTable& table : tables_) {
    if (table.from_draw)
      continue;
    const bool present = is_in(table, record);
    transfer(writer, present);
    for (const RecordVariable& variable : table.variables)
      if (present && variable.use != RecordUse::archive_only)
        write(writer, variable, record);
  }
  return writer.take();
}

ExperimentRecord RecordBytes::from_bytes(std::string_view bytes) const {
  ByteReader reader(bytes);
  std::int64_t index = 0;
  transfer(reader, index);
  ExperimentRecord record;
  record.draw = draw_experiment(study_, index);
  for (const RecordTable& table : tables_) {
    if (table.from_draw)
      continue;
    bool present = false;
    transfer(reader, present);
    if (!present && !table.has)
      throw std::runtime_error("a table is missing that every record has");
    if (present && table.make)
      table.make(record);
    for (const RecordVariable& variable : table.variables)
      if (present && variable.use != RecordUse::archive_only)
        read(reader, variable, record);
  }
  reader.require_end();
  return record;
}

std::vector<std::string> RecordBytes::differences(const ExperimentRecord& one,
                                                  const ExperimentRecord& other) const {
  std::vector<std::string> names;
  for (const RecordTable& table : tables_) {
    const std::string prefix = table.group.empty() ? "" : table.group + "/";
    if (is_in(table, one) != is_in(table, other)) {
      names.push_back(prefix.substr(0, prefix.size() - 1));
      continue;
    }
    for (const RecordVariable& variable : table.variables)
      if (variable.use == RecordUse::everywhere && is_in(table, one) && !is_lacking(variable, one) &&
          bytes_of(variable, one) != bytes_of(variable, other))
        names.push_back(prefix + variable.text.name);
  }
  return names;
}

}  // namespace mpm
