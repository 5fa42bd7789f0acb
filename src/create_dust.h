/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifdef COMMAND_CLASS
// clang-format off
CommandStyle(create_dust,CreateDust);
// clang-format on
#else

#ifndef LMP_CREATE_DUST_H
#define LMP_CREATE_DUST_H

#include "command.h"

#include "core/quaternion.h"
#include "core/texture.h"

#include <vector>

namespace LAMMPS_NS {

// puts real grains on carriers, at the overlap at which the adhesive contact carries no load

class CreateDust : public Command {
 public:
  explicit CreateDust(class LAMMPS *_lmp) : Command(_lmp), first_type(0) {}
  void command(int, char **) override;

 private:
  struct Site {    // of a grain on a carrier
    double n[3], distance, radius, mass;
    int type;
  };
  struct Classes {    // of pull-off forces, a type each: evenly in the logarithm of their factor
    int number = 0;
    double low = 1.0, high = 1.0;    // the factors between them
    int of(double factor) const;     // those beyond are taken into the last ones
    double factor(int k) const;      // in the middle of the class
  };
  struct Carrier {
    double x[3], v[3], omega[3], radius, mass;
    Dust::Quaternion orientation;
  };
  struct Size {    // of carriers: its texture on them
    double radius;
    Dust::Texture texture;
    std::vector<Site> sites;
  };
  std::vector<Size> sizes;    // from large to small
  const Size &size_of(const Carrier &) const;
  void place(const std::vector<Carrier> &, const class DustOptions &);
  Classes classes;
  int first_type;
  void read(int narg, char **arg, class DustOptions &);
  std::vector<Site> sites_of(const Dust::Texture &, const class DustOptions &) const;
  static void arm_of(const Carrier &, const Site &, double *);
  std::vector<Carrier> all_carriers(int groupbit, const DustOptions &) const;
  void check_room(const std::vector<Carrier> &) const;
  void create(const std::vector<Carrier> &);
  void warn_of_crushed_grains(const Size &, const std::vector<Carrier> &, const class DustOptions &) const;
};

}    // namespace LAMMPS_NS

#endif
#endif
