// A LAMMPS instance driven command by command, with what the style tests have in common.

#ifndef DUST_UNITTEST_DECK_H
#define DUST_UNITTEST_DECK_H

#include "detach_columns.h"
#include "library.h"
#include "lmptype.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

// the contact of the reference carrier, without the coefficient of restitution's place
inline std::string contact(double restitution, double friction = 0.05)
{
  const std::string e = std::to_string(restitution), mu = std::to_string(friction);
  return "hertz/material 210e9 " + e + " 0.3 tangential mindlin NULL 0.0 " + mu + " damping coeff_restitution/limited";
}

const std::string REFERENCE_DUST = "texture monolayer 20e-6 coverage 0.2 seed 1";

inline std::string line(const char *format, double a, double b = 0.0, double c = 0.0, double d = 0.0, double e = 0.0)
{
  char buf[512];
  std::snprintf(buf, sizeof(buf), format, a, b, c, d, e);
  return buf;
}

class Deck {
 public:
  Deck()
  {
    const char *args[] = {"dust", "-log", "none", "-screen", "none", "-nocite"};
    lmp = lammps_open_no_mpi(6, const_cast<char **>(args), nullptr);
  }
  ~Deck() { lammps_close(lmp); }
  Deck(const Deck &) = delete;
  Deck &operator=(const Deck &) = delete;

  // runs commands, one a line; returns the error message or ""
  std::string attempt(const std::string &commands)
  {
    lammps_commands_string(lmp, commands.c_str());
    if (!lammps_has_error(lmp)) return "";
    char buf[2048];
    lammps_get_last_error_message(lmp, buf, sizeof(buf));
    return buf;
  }
  void operator()(const std::string &commands)
  {
    const std::string error = attempt(commands);
    ASSERT_EQ(error, "") << commands;
  }

  // an empty box above a wall at z = 0, steel carriers of the reference case
  void box(const std::string &atom_style = "sphere")
  {
    (*this)("units si\natom_style " + atom_style +
            "\nboundary p p f\nnewton off\ncomm_modify vel yes\n"
            "region box block -0.01 0.01 -0.01 0.01 -0.002 0.01\ncreate_box 2 box\ntimestep 1e-9\nneighbor 3e-4 bin\n"
            "pair_style granular\npair_coeff * * " +
            contact(0.7) + "\n");
  }
  void carrier(double x, double y, double z, double vx, double vy, double vz)
  {
    char commands[512];
    const int id = static_cast<int>(lammps_get_natoms(lmp)) + 1;
    std::snprintf(commands, sizeof(commands),
                  "create_atoms 1 single %.17g %.17g %.17g\nset atom %d diameter 1.5e-3 density 7700\n"
                  "group new id %d\nvelocity new set %.17g %.17g %.17g\ngroup new delete",
                  x, y, z, id, id, vx, vy, vz);
    (*this)(commands);
  }
  void wall_and_motion(double restitution = 0.7)
  {
    (*this)("fix move all nve/sphere\nfix wall all wall/gran granular " + contact(restitution) + " zplane 0.0 NULL");
  }

  double global(int n) const    // 0 = scalar, else component of the vector
  {
    void *p = n ? lammps_extract_fix(lmp, "dust", LMP_STYLE_GLOBAL, LMP_TYPE_VECTOR, n - 1, 0)
                : lammps_extract_fix(lmp, "dust", LMP_STYLE_GLOBAL, LMP_TYPE_SCALAR, 0, 0);
    const double value = *static_cast<double *>(p);
    lammps_free(p);
    return value;
  }
  std::vector<double> vector() const
  {
    std::vector<double> v;
    for (int n = 0; n < LAMMPS_NS::DetachVector::SIZE; n++) v.push_back(global(n));
    return v;
  }
  // columns of the fix for the atom with this ID
  std::vector<double> columns(int id) const
  {
    auto **array = static_cast<double **>(lammps_extract_fix(lmp, "dust", LMP_STYLE_ATOM, LMP_TYPE_ARRAY, 0, 0));
    const double *row = array[local(id)];
    return {row, row + LAMMPS_NS::DetachAtom::SIZE};
  }
  std::vector<std::vector<double>> events() const
  {
    const int rows = *static_cast<int *>(lammps_extract_fix(lmp, "dust", LMP_STYLE_LOCAL, LMP_SIZE_ROWS, 0, 0));
    auto **array = static_cast<double **>(lammps_extract_fix(lmp, "dust", LMP_STYLE_LOCAL, LMP_TYPE_ARRAY, 0, 0));
    std::vector<std::vector<double>> all;
    for (int k = 0; k < rows; k++) all.emplace_back(array[k], array[k] + LAMMPS_NS::DetachRow::SIZE);
    return all;
  }
  // IDs of the atoms: 32 or 64 bits wide, as LAMMPS was built
  const LAMMPS_NS::tagint *tags() const { return static_cast<LAMMPS_NS::tagint *>(lammps_extract_atom(lmp, "id")); }
  const double *atom(const char *name, int id) const
  {
    return static_cast<double **>(lammps_extract_atom(lmp, name))[local(id)];
  }
  void *lmp;

 private:
  int local(int id) const
  {
    const LAMMPS_NS::tagint *tag = tags();
    const int n = lammps_extract_setting(lmp, "nlocal");
    for (int i = 0; i < n; i++)
      if (tag[i] == id) return i;
    ADD_FAILURE() << "no atom " << id;
    return 0;
  }
};

#endif
