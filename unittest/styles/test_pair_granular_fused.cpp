// The pair force that computes many contacts at once, and walls that look only at atoms near them, against LAMMPS' own,
// which they replace: every bit of what moves atoms and of what is put out must be the same.

#include "deck.h"

#include "fix_wall_gran_region.h"
#include "force.h"
#include "lammps.h"
#include "modify.h"
#include "pair_granular.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <typeinfo>

using LAMMPS_NS::LAMMPS;
using LAMMPS_NS::PairGranular;

namespace {

LAMMPS_NS::Pair *own_pair(LAMMPS *lmp) { return new PairGranular(lmp); }

template <class Wall> LAMMPS_NS::Fix *own_wall(LAMMPS *lmp, int narg, char **arg) { return new Wall(lmp, narg, arg); }

void use_lammps_own(LAMMPS *lmp)
{
  lmp->force->pair_map->at("granular") = &own_pair;
  lmp->modify->fix_map->at("wall/gran") = &own_wall<LAMMPS_NS::FixWallGran>;
  lmp->modify->fix_map->at("wall/gran/region") = &own_wall<LAMMPS_NS::FixWallGranRegion>;
}

// all numbers of a state, bit by bit
using State = std::vector<std::uint64_t>;

void put(State &state, const double *values, int n)
{
  for (int k = 0; k < n; k++) {
    std::uint64_t bits;
    std::memcpy(&bits, values + k, sizeof(bits));
    state.push_back(bits);
  }
}

State state_of(const Deck &deck)
{
  State state;
  for (int id = 1; id <= static_cast<int>(lammps_get_natoms(deck.lmp)); id++)
    for (const char *name : {"x", "v", "omega", "f", "torque"}) put(state, deck.atom(name, id), 3);
  put(state, static_cast<double *>(lammps_extract_compute(deck.lmp, "thermo_press", LMP_STYLE_GLOBAL, LMP_TYPE_VECTOR)),
      6);
  return state;
}

// number of values that differ after each of the runs, made by LAMMPS' own loop and by ours
int differences(const std::string &set_up, const std::vector<std::string> &runs)
{
  std::vector<State> states[2];
  for (const bool ours : {false, true}) {
    Deck deck;
    auto *lmp = static_cast<LAMMPS *>(deck.lmp);
    if (!ours) use_lammps_own(lmp);
    deck(set_up);
    for (const std::string &run : runs) {
      deck(run);
      states[ours].push_back(state_of(deck));
    }
    const LAMMPS_NS::Pair *pair = lmp->force->pair_match("granular", 1);
    EXPECT_TRUE(pair && (typeid(*pair) != typeid(PairGranular)) == ours);
  }
  int different = 0;
  for (std::size_t run = 0; run < runs.size(); run++) {
    EXPECT_EQ(states[0][run].size(), states[1][run].size());
    for (std::size_t k = 0; k < states[0][run].size(); k++) different += states[0][run][k] != states[1][run][k];
    EXPECT_NE(states[0][run], states[0][run ? run - 1 : run + 1]) << "nothing has moved";
  }
  return different;
}

// what restart files do not keep
std::string with_forces(const std::string &pairs, const std::string &more)
{
  return "timestep 1e-6\nneighbor 2e-4 bin\ncomm_modify vel yes\n" + pairs +
         "\nfix move all nve/sphere\nfix floor all wall/gran granular hertz/material 2.1e8 0.7 0.3 tangential mindlin "
         "NULL 0.0 0.3 damping coeff_restitution/limited zplane 0.0 8.4e-3\nthermo 1\n" +
         more;
}

// 216 spheres of three types and many sizes, overlapping from the start, that fly and spin in all directions
std::string shaken_box(const std::string &pairs, const std::string &more = "", const std::string &newton = "off")
{
  return "units si\natom_style sphere\nboundary p p f\nnewton " + newton +
         "\nregion box block 0 8.4e-3 0 8.4e-3 0 8.4e-3\ncreate_box 3 box\n"
         "lattice sc 1.4e-3 origin 0.5 0.5 0.5\ncreate_atoms 1 box\nset type 1 type/fraction 2 0.4 17\n"
         "set type 2 type/fraction 3 0.3 18\nvariable size atom random(1.2e-3,1.5e-3,5)\nset group all diameter "
         "v_size\n"
         "set group all density 7700\nvariable a atom random(-1,1,6)\nvariable b atom random(-1,1,7)\n"
         "variable c atom random(-1,1,8)\nvelocity all set v_a v_b v_c\nvariable d atom 500*random(-1,1,9)\n"
         "set group all omega v_d v_d v_d\n" +
         with_forces(pairs, more);
}

std::string steel(const std::string &modulus = "2.1e8", const std::string &shear_damping = "0.0",
                  const std::string &friction = "0.3")
{
  return " hertz/material " + modulus + " 0.7 0.3 tangential mindlin NULL " + shear_damping + " " + friction +
         " damping coeff_restitution/limited ";
}

// soft enough for the time step: adhesion is felt over some steps
std::string sticky(const std::string &shear_damping = "0.0", const std::string &name = "jkr/vdw",
                   const std::string &end = "")
{
  return " " + name + " 1e7 2e5 0.3 1e-13 1e-7 " + end + " tangential mindlin NULL " + shear_damping +
         " 0.3 damping viscoelastic rolling dominik/tielens 0.05 ";
}

const std::string GRANULAR = "pair_style granular\npair_coeff * *";
const std::vector<std::string> RUNS = {"run 0", "run 1", "run 300", "run 0", "run 200"};
const std::string VERLET = LAMMPS_VERSION_NUMBER >= 20260704 ? "synchronized_verlet" : "";

}    // namespace

TEST(PairGranularFused, Carriers)
{
  EXPECT_EQ(differences(shaken_box(GRANULAR + steel()), RUNS), 0);
  EXPECT_EQ(differences(shaken_box(GRANULAR + steel(), "", "on"), RUNS), 0);
  EXPECT_EQ(differences(shaken_box(GRANULAR + steel("2.1e8", "0.5") + "limit_damping"), RUNS), 0);
  EXPECT_EQ(differences(shaken_box(GRANULAR + steel("2.1e8", "0.0", "0.0")), RUNS), 0);
  EXPECT_EQ(differences(shaken_box(GRANULAR + " hertz 1.5e8 0.5 tangential mindlin 1e8 0.2 0.4 damping "
                                              "coeff_restitution/limited"),
                        RUNS),
            0);
}

TEST(PairGranularFused, CarriersOfManyMaterials)
{
  EXPECT_EQ(differences(shaken_box("pair_style granular\npair_coeff 1 1" + steel() + "\npair_coeff 2 2" +
                                   steel("1e8", "0.3", "0.1") + "\npair_coeff 3 3" + steel("3e8", "0.0", "0.0")),
                        RUNS),
            0);
}

TEST(PairGranularFused, Synchronized)
{
  EXPECT_EQ(differences(shaken_box(GRANULAR + steel() + VERLET), RUNS), 0);
  EXPECT_EQ(differences(shaken_box(GRANULAR + steel("2.1e8", "0.5") + VERLET), RUNS), 0);
  EXPECT_EQ(differences(shaken_box(GRANULAR + sticky() + VERLET), RUNS), 0);
  EXPECT_EQ(differences(shaken_box(GRANULAR + sticky("0.5") + VERLET), RUNS), 0);
  // only some of the contacts
  EXPECT_EQ(differences(shaken_box(GRANULAR + steel("2.1e8", "0.5") + VERLET + "\npair_coeff * 2" + steel() +
                                   "\npair_coeff 1 3" + sticky() + VERLET + "\npair_coeff 3 3" + sticky("0.5")),
                        RUNS),
            0);
}

TEST(PairGranularFused, Grains)
{
  EXPECT_EQ(differences(shaken_box(GRANULAR + sticky()), RUNS), 0);
  EXPECT_EQ(differences(shaken_box(GRANULAR + sticky("0.4"), "", "on"), RUNS), 0);
  EXPECT_EQ(differences(shaken_box(GRANULAR + sticky("0.0", "jkr/vdw/cut", "5e-6")), RUNS), 0);
}

TEST(PairGranularFused, GrainsAmongCarriers)
{
  EXPECT_EQ(differences(shaken_box(GRANULAR + steel() + "\npair_coeff 1 2" + sticky() + "\npair_coeff 2*3 2*3" +
                                   sticky("0.2", "jkr/vdw/cut", "5e-6")),
                        RUNS),
            0);
}

// a deck that thinks better of it: a model that no pair of types has
TEST(PairGranularFused, ModelsThatNoPairHas)
{
  EXPECT_EQ(differences(shaken_box(GRANULAR + sticky() + "\npair_coeff * *" + steel()), RUNS), 0);
  EXPECT_EQ(differences(shaken_box(GRANULAR + steel() + "\npair_coeff * *" + sticky()), RUNS), 0);
}

// laws that are LAMMPS' own or have other parts, between the others
TEST(PairGranularFused, OtherLawsInTheirPlaces)
{
  const std::string tsuji = " hertz/material 2e8 0.6 0.3 tangential mindlin NULL 0.1 0.3 damping tsuji";
  const std::string rescaled =
      " hertz/material 2e8 0.6 0.3 tangential mindlin_rescale/force NULL 0.1 0.3 damping coeff_restitution/limited";
  const std::string jkr = " jkr 1e7 1e-6 0.3 0.5 tangential mindlin NULL 0.0 0.3 rolling sds 1e3 0.0 0.1";
  const std::string no_rolling = " jkr/vdw 1e7 2e5 0.3 1e-13 1e-7 tangential mindlin NULL 0.0 0.3 damping viscoelastic";
  for (const std::string &other : {tsuji, rescaled, jkr, no_rolling}) {
    EXPECT_EQ(differences(shaken_box(GRANULAR + steel() + "\npair_coeff 2 *" + other + "\npair_coeff 1 3" + sticky()),
                          RUNS),
              0);
    EXPECT_EQ(differences(shaken_box(GRANULAR + other), RUNS), 0);
  }
}

TEST(PairGranularFused, FrozenAtomsAndOtherPairStyles)
{
  const std::string both = GRANULAR + steel() + "\npair_coeff 2 *" + sticky();
  EXPECT_EQ(differences(shaken_box(both, "group still type 3\nfix still still freeze"), RUNS), 0);
  EXPECT_EQ(differences(shaken_box("pair_style hybrid granular zero 1.5e-3\npair_coeff * * granular" + steel() +
                                   "\npair_coeff 2 3 zero\npair_coeff 3 3 granular" + sticky()),
                        RUNS),
            0);
}

// when atoms change places, stresses are asked for, or the time step changes
TEST(PairGranularFused, BetweenSteps)
{
  const std::string both = GRANULAR + steel() + "\npair_coeff 2 *" + sticky();
  EXPECT_EQ(differences(shaken_box(both, "atom_modify sort 10 1e-3\nneigh_modify every 1 check no"), RUNS), 0);
  EXPECT_EQ(differences(shaken_box(both, "compute stress all stress/atom NULL\ncompute sum all reduce sum "
                                         "c_stress[1]\nthermo_style custom step press c_sum"),
                        RUNS),
            0);
  EXPECT_EQ(differences(shaken_box(both), {"run 100", "timestep 5e-7\nrun 100 pre no", "timestep 2e-6\nrun 100"}), 0);
  EXPECT_EQ(differences(shaken_box(both), {"run 100", "pair_coeff 1 1" + steel("1e8", "0.2") + "\nrun 100"}), 0);
}

// pairs that were far come close at once, by a hand or by growing
TEST(PairGranularFused, AtomsThatAreMovedAndGrow)
{
  const std::string both = GRANULAR + steel() + "\npair_coeff 2 *" + sticky();
  const std::string away = "group some id 1:60\ndisplace_atoms some move 9e-5 3e-5 -6e-5 units box\n";
  EXPECT_EQ(differences(shaken_box(both), {"run 100", away + "run 50 pre no", away + "run 100"}), 0);
  const std::string grow = "variable grown equal 1.2e-3+1e-6*step\nfix grow all adapt 1 atom diameter v_grown\n";
  std::string growing = shaken_box(both, grow);
  growing.replace(growing.find("sphere"), 6, "sphere 1");
  EXPECT_EQ(differences(growing, {"run 100", "run 100"}), 0);
  EXPECT_EQ(differences(shaken_box(both, "neighbor 0.0 bin"), RUNS), 0);    // each step is a list of its own
}

// what was found of pairs and of walls is kept from run to run: types, the skin and who has computed last may change
TEST(PairGranularFused, WhatChangesWithoutANewList)
{
  const std::string far = " jkr/vdw/cut 1e7 2e5 0.3 1e-13 1e-7 6e-5 tangential mindlin NULL 0.0 0.3 damping "
                          "viscoelastic rolling dominik/tielens 0.05 ";
  const std::string grains = GRANULAR + sticky() + "\npair_coeff 2 *" + sticky("0.4") + "\npair_coeff 3 3" + far;
  const std::string types = "variable other atom 1+(id+step)%3\nfix types all set 25 0 group all type v_other";
  EXPECT_EQ(differences(shaken_box(grains, types), {"run 10", "run 200", "run 50 pre no"}), 0);
  const std::string still = "velocity all scale 1e-9\nfix hold all setforce 0 0 0\nneighbor 1e-6 bin\n"
                            "neigh_modify every 1000 delay 1000 check no\n";
  const std::string fly = "velocity all set 0.0 0.0 v_c\nneighbor 2e-3 bin\nrun 100 pre no";
  const std::string region = "region inner plane 0 0 1.3e-3 0 0 1 units box\n"
                             "fix inner all wall/gran/region granular" +
                             steel() + "region inner";
  for (const std::string &more : {std::string(), region})
    EXPECT_EQ(differences(shaken_box(GRANULAR + steel(), more), {"velocity all scale 1e-6\n" + still + "run 2", fly}),
              0);
  // contacts that LAMMPS' own loop has seen end, and that begin again
  const std::string one_list = "neighbor 2e-3 bin\nneigh_modify every 1000 delay 1000 check no\n"
                               "group some id 1:216:2\nvariable there atom x+6e-5\nvariable back atom x-6e-5\n";
  EXPECT_EQ(differences(shaken_box(GRANULAR + steel(), one_list),
                        {"run 5", "special_bonds lj 0.5 0.5 0.5\nset group some x v_there\nrun 1 pre no",
                         "special_bonds lj 1 1 1\nset group some x v_back\nrun 5 pre no", "run 50"}),
            0);
}

// LAMMPS gives contacts room for their history once
TEST(PairGranularFused, HistoryOfAnotherLength)
{
  Deck refused;
  refused(shaken_box(GRANULAR + steel()) + "\nrun 10");
  const std::string error = refused.attempt(GRANULAR + sticky() + "\nrun 0");
  EXPECT_NE(error.find("keeps 3 values of each contact since its first run, and now has models with 10"),
            std::string::npos)
      << error;
  Deck deck;
  deck(shaken_box(GRANULAR + sticky()) + "\nrun 10\n" + GRANULAR + steel() + "\nrun 10");
  EXPECT_EQ(differences(shaken_box(GRANULAR + steel()),
                        {"run 100", "pair_style none\n" + GRANULAR + sticky() + "\nrun 100", "run 100"}),
            0);
}

// written by one, read by the other: contacts of pairs and of walls go on as they were
TEST(PairGranularFused, RestartFilesBothWays)
{
  const std::string file = "pair_granular.restart",
                    pairs = GRANULAR + steel("2.1e8", "0.2") + "\npair_coeff 2 *" + sticky();
  const std::string walls =
      "region wall cylinder z 4.2e-3 4.2e-3 4e-3 INF INF units box\nfix wall all wall/gran/region "
      "granular" +
      sticky() + "region wall\nunfix floor\nfix floor all wall/gran granular" + sticky() + "zplane 0.0 8.4e-3";
  std::vector<State> ends;
  for (const bool ours_writes : {false, true})
    for (const bool ours_reads : {false, true}) {
      Deck before, after;
      if (!ours_writes) use_lammps_own(static_cast<LAMMPS *>(before.lmp));
      if (!ours_reads) use_lammps_own(static_cast<LAMMPS *>(after.lmp));
      before(shaken_box(pairs, walls));
      before("run 300\nwrite_restart " + file);
      after("read_restart " + file + "\n" + with_forces(pairs, walls));
      after("run 0");
      const State start = state_of(after);
      after("run 200");
      ends.push_back(start);
      for (const std::uint64_t bits : state_of(after)) ends.back().push_back(bits);
      EXPECT_EQ(ends.back(), ends.front()) << ours_writes << ours_reads;
    }
  // that they have a past: without it they would go on otherwise
  Deck before, after;
  before(shaken_box(pairs, walls));
  before("run 300\nwrite_data " + file + " nocoeff");
  after("units si\natom_style sphere\nboundary p p f\nnewton off\nread_data " + file + "\n" +
        with_forces(pairs, walls));
  after("run 0");
  const State forgetful = state_of(after);
  EXPECT_FALSE(std::equal(forgetful.begin(), forgetful.end(), ends.front().begin()));
  std::remove(file.c_str());
}

// near enough to be looked at again, out of reach, on the other side, from one wall to the other
TEST(FixWallGranNear, Planes)
{
  const std::string pair = GRANULAR + steel();
  const std::string wall = "unfix floor\nfix floor all wall/gran granular", sides = " zplane 0.0 8.4e-3";
  EXPECT_EQ(differences(shaken_box(pair, wall + sticky() + sides), RUNS), 0);
  EXPECT_EQ(differences(shaken_box(pair, wall + sticky("0.0", "jkr/vdw/cut", "5e-6") + sides + " contacts"), RUNS), 0);
  EXPECT_EQ(differences(shaken_box(pair, wall + steel() + sides + " contacts"), RUNS), 0);
  EXPECT_EQ(differences(shaken_box(pair, wall + steel() + " zplane 0.1e-3 NULL\nfix top all wall/gran granular" +
                                             steel() + " zplane NULL 8.3e-3"),
                        RUNS),
            0);
  EXPECT_EQ(differences(shaken_box(pair, wall + steel() + sides + " wiggle z 1e-4 1e-3"), RUNS), 0);
  EXPECT_EQ(differences(shaken_box(pair, wall + steel() + sides + " shear x 0.5"), RUNS), 0);
  // laws that are LAMMPS' own, with an end that is known and without
  for (const std::string law :
       {" jkr 1e7 1e-6 0.3 0.5 tangential mindlin NULL 0.0 0.3", " hooke 1e3 0.5 tangential linear_history 3e2 0.5 0.3",
        " hertz/material 2e8 0.6 0.3 tangential mindlin NULL 0.1 0.3 rolling sds 1e3 0.0 0.1 twisting marshall",
        " jkr/vdw 1e7 2e5 0.3 1e-13 1e-7 tangential mindlin NULL 0.0 0.3 damping viscoelastic"}) {
    EXPECT_EQ(differences(shaken_box(pair, wall + law + sides), RUNS), 0);
    EXPECT_EQ(differences(shaken_box(pair, wall + law + sides + " shear y 0.3"), RUNS), 0);
  }
  EXPECT_EQ(differences(shaken_box(pair, wall + sticky("0.4") + sides + " shear x 0.5"), RUNS), 0);
  EXPECT_EQ(differences(shaken_box(pair), {"run 100", "displace_atoms all move 0 0 -5e-5 units box\nrun 50 pre no"}),
            0);
}

// an atom forgets what it had of the wall when it is seen far from it, which it is in the wall's group only
TEST(FixWallGranNear, AtomsThatLeaveAndJoinTheGroup)
{
  for (const std::string &law : {steel(), sticky()})
    EXPECT_EQ(differences(shaken_box(GRANULAR + steel(), "group some id 1:216\nunfix floor\nfix floor some wall/gran "
                                                         "granular" +
                                                             law +
                                                             "zplane 0.0 8.4e-3\n"
                                                             "neigh_modify every 1000 delay 1000 check no"),
                          {"run 6", "group some clear\ndisplace_atoms all move 0 0 8e-4 units box\nrun 1 pre no",
                           "group some id 1:216\nrun 1 pre no",
                           "displace_atoms all move 0 0 -8e-4 units box\nrun 30 pre no"}),
              0);
}

namespace {

// a wall of a region, and variables that move one
std::string walled(const std::string &region, const std::string &law)
{
  return shaken_box(GRANULAR + steel(), "variable way equal 1e-4*sin(5e3*time)\nvariable turn equal 300*time\n"
                                        "variable lowest equal 0.5*bound(all,zmin)\n"
                                        "variable shaken equal 1e-6*random(-1,1,8)\nregion wall " +
                                            region + "\nfix wall all wall/gran/region granular" + law + "region wall");
}

}    // namespace

TEST(FixWallGranNear, Regions)
{
  for (const std::string &law : {steel(), sticky()}) {
    EXPECT_EQ(differences(walled("block 1e-3 7e-3 1e-3 7e-3 INF INF units box", law), RUNS), 0);
    EXPECT_EQ(differences(walled("block 3e-3 5e-3 3e-3 5e-3 3e-3 5e-3 side out units box", law), RUNS), 0);
    EXPECT_EQ(differences(walled("cylinder z 4.2e-3 4.2e-3 4e-3 INF INF units box", law), RUNS), 0);
    EXPECT_EQ(differences(walled("sphere 4.2e-3 4.2e-3 4.2e-3 4e-3 units box", law), RUNS), 0);
    EXPECT_EQ(differences(walled("plane 0 0 2e-3 0.1 0.2 0.9 units box", law), RUNS), 0);
    // moving, turning about an axis of their own and another one
    EXPECT_EQ(differences(walled("plane 0 0 2e-3 0.1 0.2 0.9 units box move v_way NULL v_way", law), RUNS), 0);
    EXPECT_EQ(differences(walled("cylinder y 4.2e-3 4.2e-3 4e-3 INF INF units box rotate v_turn 4.2e-3 0 4.2e-3 0 1 0",
                                 law),
                          RUNS),
              0);
    EXPECT_EQ(differences(walled("block 1e-3 7e-3 1e-3 7e-3 INF INF units box rotate v_turn 4e-3 3e-3 0 0 0 1", law),
                          RUNS),
              0);
    // what is left to LAMMPS
    EXPECT_EQ(differences(walled("cone z 4.2e-3 4.2e-3 2e-3 4e-3 1e-3 8e-3 units box open 2", law), RUNS), 0);
  }
}

// LAMMPS asks a variable for the motion once a step, with all atoms in their groups
TEST(FixWallGranNear, RegionsThatFollowAtomsOrChance)
{
  for (const std::string way : {"v_lowest", "v_shaken"}) {
    EXPECT_EQ(differences(walled("plane 0 0 2e-3 0.1 0.2 0.9 units box move NULL NULL " + way, steel()), RUNS), 0);
    EXPECT_EQ(differences(walled("block INF INF INF INF 0 8e-3 units box move NULL NULL " + way, sticky()), RUNS), 0);
  }
}

// atoms whose centers are at the surface when they are looked at, and soon within or beyond it
TEST(FixWallGranNear, CentersOnTheSurfaceOfARegion)
{
  EXPECT_EQ(differences(walled("cylinder z 4.2e-3 4.2e-3 4.94975e-3 INF INF units box", steel()), RUNS), 0);
  EXPECT_EQ(differences(walled("sphere 4.2e-3 4.2e-3 4.2e-3 6.06218e-3 units box", steel()), RUNS), 0);
}
