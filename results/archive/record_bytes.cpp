#include "results/archive/record_bytes.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "results/archive/variable_text.hpp"
#include "results/files/byte_stream.hpp"
#include "scenarios/loop/draw.hpp"

namespace mpm {
namespace {

/// Writes the bytes of a row: each text after its length, all numbers of a row as one block.
void write(ByteWriter& writer, const RecordRow& row, const ExperimentRecord& record) {
  take_values(row, record, [&]<class T>(const std::vector<T>& values) {
    if constexpr (std::is_same_v<T, std::string>) {
      for (const std::string& text : values)
        transfer(writer, text);
    } else {
      writer.block(values.data(), values.size() * sizeof(T));
    }
  });
}

void read(ByteReader& reader, const RecordRow& row, ExperimentRecord& record) {
  put_values(row, record, [&]<class T>(std::vector<T>& values) {
    if constexpr (std::is_same_v<T, std::string>) {
      for (std::string& text : values)
        transfer(reader, text);
    } else {
      reader.block(values.data(), values.size() * sizeof(T));
    }
    if (const T* const value = value_without_word(row.text, values))
      throw std::runtime_error(fmt::format("{} is {}, which is none of its values", row.text.name, *value));
  });
}

/// Tells whether the record is from an archive that lacks this row: then it has no number there.
bool is_lacking(const RecordRow& row, const ExperimentRecord& record) {
  if (row.since == 0)
    return false;
  const std::vector<double> values = numbers_of(row, record);
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isnan(value); });
}

std::string bytes_of(const RecordRow& row, const ExperimentRecord& record) {
  ByteWriter writer;
  write(writer, row, record);
  return writer.take();
}

}  // namespace

RecordBytes::RecordBytes(const Study& study, std::vector<RecordTable> tables)
    : study_(study), tables_(std::move(tables)) {}

std::string RecordBytes::to_bytes(const ExperimentRecord& record) const {
  ByteWriter writer;
  transfer(writer, record.draw.index);
  for (const RecordTable& table : tables_) {
    if (table.from_draw)
      continue;
    const bool present = table.covers(record);
    transfer(writer, present);
    for (const RecordRow& row : table.rows)
      if (present && row.use != RowUse::archive_only)
        write(writer, row, record);
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
    for (const RecordRow& row : table.rows)
      if (present && row.use != RowUse::archive_only)
        read(reader, row, record);
  }
  reader.require_end();
  return record;
}

std::vector<std::string> RecordBytes::differences(const ExperimentRecord& one,
                                                  const ExperimentRecord& other) const {
  std::vector<std::string> names;
  for (const RecordTable& table : tables_) {
    const std::string prefix = table.group.empty() ? "" : table.group + "/";
    if (table.covers(one) != table.covers(other)) {
      names.push_back(prefix.substr(0, prefix.size() - 1));
      continue;
    }
    for (const RecordRow& row : table.rows)
      if (row.use == RowUse::everywhere && table.covers(one) && !is_lacking(row, one) &&
          bytes_of(row, one) != bytes_of(row, other))
        names.push_back(prefix + row.text.name);
  }
  return names;
}

}  // namespace mpm
