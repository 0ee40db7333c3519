#pragma once

#include <string>

#include "results/records/record_columns.hpp"

namespace mpm {

/// The kind of quality codes in a column.
enum class OpcCodes {
  da,  ///< OPC DA: bits 6 and 7 of the lower byte hold the quality; 3 is good
  ua,  ///< OPC UA: status codes; bits 30 and 31 are 0 for good
};

/// Returns OPC UA if a number of the column is at least 2^30, or negative (a code of 32 bits with a sign);
/// otherwise OPC DA.
OpcCodes opc_codes(const RecordColumns& file, std::size_t column);

/// Tells whether the cell is a code and not a word.
bool is_opc_code(const RecordColumns& file, const std::string& cell);

/// Tells whether the quality in this cell is good: a word that begins with good, or a number (also 0x...)
/// with a good code.
bool is_good_opc(const RecordColumns& file, const std::string& cell, OpcCodes codes);

/// Tells whether the cell can be a quality, good or not: a word, or a code whose bits OPC defines.
bool is_opc_quality(const RecordColumns& file, const std::string& cell, OpcCodes codes);

}  // namespace mpm
