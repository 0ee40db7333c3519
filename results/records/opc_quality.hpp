#pragma once

#include <string>

#include "results/records/record_columns.hpp"

namespace mpm {

/// The codes of quality in a column.
enum class OpcCodes {
  da,  ///< OPC DA: the lower byte has the quality in its bits 6 and 7, 3 for good
  ua,  ///< OPC UA: status codes whose bits 30 and 31 are 0 for good
};

/// OPC UA if a number of the column is 2^30 or above, or negative, as a code of 32 bits with a sign is;
/// otherwise OPC DA.
OpcCodes opc_codes(const RecordColumns& file, std::size_t column);

/// Is it a code, and no word?
bool is_opc_code(const RecordColumns& file, const std::string& cell);

/// Is the quality in this cell good: a word that begins with good, or a number (also 0x...) whose code is?
bool is_good_opc(const RecordColumns& file, const std::string& cell, OpcCodes codes);

/// Can this be a quality, good or not: a word, or a code whose bits OPC defines?
bool is_opc_quality(const RecordColumns& file, const std::string& cell, OpcCodes codes);

}  // namespace mpm
