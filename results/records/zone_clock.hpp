#pragma once

#include <memory>
#include <optional>
#include <string>

namespace mpm {

/// The offset of a zone by the letters that are written for it, such as CET or EDT, in s; none for letters
/// that nobody uses, and for those that several zones use (CST, IST, BST).
std::optional<double> offset_of_letters(const std::string& letters);

/// The clocks of a time zone, with all their changes, from the time zone database of the system.
class ZoneClock {
 public:
  /// By its IANA name, "Europe/Berlin". Errors: InputError at `place` for an unknown name.
  ZoneClock(const std::string& name, const std::string& place);
  ~ZoneClock();
  ZoneClock(ZoneClock&&) noexcept;
  ZoneClock& operator=(ZoneClock&&) noexcept;

  /// The time in UTC at which its clocks show `local`, both in s since 1970. Where they show it twice: the
  /// one for which they have these letters; without letters the first that is not before `earliest`. None
  /// where no clock shows it, or not with these letters.
  std::optional<double> utc(double local, const std::string& letters, double earliest) const;

 private:
  struct Zone;
  std::unique_ptr<const Zone> zone_;
};

}  // namespace mpm
