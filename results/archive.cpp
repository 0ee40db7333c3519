#include "results/archive.hpp"

#include "results/archive_groups.hpp"
#include "results/atomic_file.hpp"

namespace mpm {

void write_archive(const std::filesystem::path& path, const Campaign& campaign) {
  const Hdf5File file = Hdf5File::create(path.string());
  Hdf5Group root = file.root();
  write_heading(root, campaign);
  write_experiments(root, campaign);
  write_nominal(root, campaign.study, campaign.basis.sensitivity);
  write_basis(root, campaign.study, campaign.basis);
  write_trajectories(root, campaign);
  write_aggregate(root, campaign);
  write_file_atomically(path, file.image());
}

Campaign read_archive(const std::filesystem::path& path) {
  const Hdf5File file = Hdf5File::open(path);
  const Hdf5Group root = file.root();
  const std::string name = path.string();
  Campaign campaign = read_heading(root, name);
  campaign.records = read_experiments(root, campaign.study, name);
  campaign.basis = read_basis(root, campaign.study, read_nominal(root, campaign.study, name), name);
  read_trajectories(root, campaign.study, campaign.records, name);
  return campaign;
}

}  // namespace mpm
