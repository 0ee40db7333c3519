#pragma once

#include <string>
#include <vector>

#include "analysis/reproduction/table_reproduction.hpp"

namespace mpm {

/// How tables are reproduced.
struct ReproductionPlan {
  int seeds = 1;  ///< each table with the seeds of its studies, these plus 1, ...
  int jobs =
      1;  ///< OpenMP threads; with a solver other than active-set always one, since Ipopt has no threads
  std::string solver = "active-set";
};

/// Every table with every seed: result[table][seed], whatever the number of threads. Errors: as reproduce(),
/// that of the first table and seed.
std::vector<std::vector<ReproducedTable>> run_tables(const std::vector<ThesisTable>& tables,
                                                     const ReproductionPlan& plan);

}  // namespace mpm
