#pragma once

#include <optional>
#include <string>
#include <vector>

#include "results/archive/campaign.hpp"
#include "results/archive/hdf5_file.hpp"

namespace mpm {

// The parts of an archive, each written and read by functions beside each other. A group has its own
// dimensions, so that it opens alone (`xarray.open_dataset(path, group="basis")`) with the names of its
// variables. `file` is for messages of ArchiveError, which all readers throw.

/// Root attributes.
void write_heading(Hdf5Group& root, const Campaign& campaign);
/// Checks that the file is an archive of this version, and reads study and info.
Campaign read_heading(const Hdf5Group& root, const std::string& file);

/// Root: the table of experiments.
void write_experiments(Hdf5Group& root, const Campaign& campaign);
std::vector<ExperimentRecord> read_experiments(const Hdf5Group& root, const Study& study,
                                               const std::string& file);

/// /nominal: T0.
void write_nominal(Hdf5Group& root, const Study& study, const NominalSensitivity& sensitivity);
NominalSensitivity read_nominal(const Hdf5Group& root, const Study& study, const std::string& file);

/// /nominal_fixed: T0 with the fixed MVs of the study held; there is no such group when it fixes none.
void write_nominal_fixed(Hdf5Group& root, const Study& study,
                         const std::optional<NominalSensitivity>& sensitivity);
std::optional<NominalSensitivity> read_nominal_fixed(const Hdf5Group& root, const Study& study,
                                                     const std::string& file);

/// /nominal_direct: the direct step responses beside an identified T0, and how far they are from it; no such
/// group unless the study wants T0 identified.
void write_nominal_direct(Hdf5Group& root, const Study& study, const BasisCase& basis);
std::optional<NominalSensitivity> read_nominal_direct(const Hdf5Group& root, const Study& study,
                                                      const NominalSensitivity& identified,
                                                      const std::string& file);

/// /s0_sensitivity: Ivar_diag with a modified S0; no such group when the study asks for none. What follows
/// from the rest (fits, ratios) is not read back.
void write_s0_sensitivity(Hdf5Group& root, const Campaign& campaign);
void read_s0_sensitivity(const Hdf5Group& root, const Study& study, std::vector<ExperimentRecord>& records,
                         const std::string& file);

/// /scenarios: every CV of the named scenarios on its own; no such group in a study of random experiments.
/// Names, truth and totals follow from the rest and are not read back.
void write_scenarios(Hdf5Group& root, const Campaign& campaign);
void read_scenarios(const Hdf5Group& root, const Study& study, std::vector<ExperimentRecord>& records,
                    const std::string& file);
/// The autocorrelations of the basis case, which stand in /scenarios.
void read_basis_acf(const Hdf5Group& root, const Study& study, BasisCase& basis, const std::string& file);

/// /basis: the operating point and the run without mismatch and disturbance.
void write_basis(Hdf5Group& root, const Study& study, const BasisCase& basis);
/// `sensitivity` is what read_nominal() gave: the basis case has the same active limits.
BasisCase read_basis(const Hdf5Group& root, const Study& study, NominalSensitivity sensitivity,
                     const std::string& file);

/// /trajectories: the loops that were kept; no such group when none was.
void write_trajectories(Hdf5Group& root, const Campaign& campaign);
void read_trajectories(const Hdf5Group& root, const Study& study, std::vector<ExperimentRecord>& records,
                       const std::string& file);

/// /audit: what the audit found; no such group without audited steps.
void write_audit(Hdf5Group& root, const std::vector<AuditedStep>& audit);
std::vector<AuditedStep> read_audit(const Hdf5Group& root, const std::string& file);

/// /aggregate: all numbers of a StudyAggregate. They follow from the rest and are not read back.
void write_aggregate(Hdf5Group& root, const Campaign& campaign);

/// /comparison: what methods of assessment say of the loops, and how often they are right; no such group
/// until a comparison was made. Rates and paired tests follow from the rest and are not read back.
void write_comparison(Hdf5Group& root, const Campaign& campaign);
/// Puts the comparison into `campaign`, whose study and records have been read; nothing without the group.
void read_comparison(const Hdf5Group& root, Campaign& campaign, const std::string& file);

}  // namespace mpm
