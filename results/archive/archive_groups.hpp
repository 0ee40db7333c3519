#pragma once

#include <optional>
#include <string>
#include <vector>

#include "results/archive/campaign.hpp"
#include "results/archive/hdf5_file.hpp"
#include "results/archive/record_tables.hpp"

namespace mpm {

// The parts of an archive, each written and read by functions beside each other. A group has its own
// dimensions, so that it opens alone (`xarray.open_dataset(path, group="basis")`) with the names of its
// variables. `file` is for messages of ArchiveError, which all readers throw.

/// Root attributes.
void write_heading(Hdf5Group& root, const Campaign& campaign);
/// Checks that the file is an archive of this version, and reads study and info.
Campaign read_heading(const Hdf5Group& root, const std::string& file);

/// The tables of record_tables(): the root group, /methods/NAME, /trajectories (no such group when no loop
/// was kept) and /s0_perturbation. They are read by ArchiveRecordReader.
void write_records(Hdf5Group& root, const Campaign& campaign, const std::vector<RecordTable>& tables);

/// Attributes of /methods/NAME: who the methods are. Their groups have been written.
void write_methods(Hdf5Group& root, const Campaign& campaign, const StudyFindings& findings);
/// The methods of an archive, also those that this program does not have.
std::vector<CampaignMethod> read_methods(const Hdf5Group& root, const Study& study, const std::string& file);
/// Their processor times, which are in no record.
std::vector<double> read_method_times(const Hdf5Group& root, const AssessmentForms& forms);

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

/// /s0_perturbation beside the records in it: what follows from them and is not read back (fits, ratios). No
/// such group when the study asks for none.
void write_s0_perturbation(Hdf5Group& root, const Campaign& campaign);

/// /scenarios: names and truth of the named scenarios, which follow from the study and are not read back; no
/// such group in a study of random experiments.
void write_scenarios(Hdf5Group& root, const Campaign& campaign);

/// /basis: the operating point and the run without mismatch and disturbance.
void write_basis(Hdf5Group& root, const Study& study, const BasisCase& basis);
/// `sensitivity` is what read_nominal() gave: the basis case has the same active limits.
BasisCase read_basis(const Hdf5Group& root, const Study& study, NominalSensitivity sensitivity,
                     const std::string& file);

/// /calibration: the scores of the calibration loops; no such group when the study asks for none.
void write_calibration(Hdf5Group& root, const Campaign& campaign);
/// `campaign` has its study and its methods.
Calibration read_calibration(const Hdf5Group& root, const Campaign& campaign, const std::string& file);

/// /audit: what the audit found; no such group without audited steps.
void write_audit(Hdf5Group& root, const std::vector<AuditedStep>& audit);
std::vector<AuditedStep> read_audit(const Hdf5Group& root, const std::string& file);

/// /findings: the rows of the table of findings, and the arrays behind them. They follow from the rest and
/// are not read back.
void write_findings(Hdf5Group& root, const Campaign& campaign, const StudyFindings& findings);

}  // namespace mpm
