# Three sieve fractions covered with dust are poured into a tube, then fall onto a plate from 20 cm: what do they lose?
# One fix serves them all. Takes about half a minute.
#
#   lmp -in in.sieve                                     (dustplugin.so and dust_styles.so in the working folder)
#   lmp -in in.sieve -var height 1 -var spread 2
#   lmp -in in.sieve -var dump FILE                      (also all carriers every 0.1 ms of the splash)
#
# Each fraction has a third of the carriers' mass and a texture of its own (sizes 0), of the same coverage. Pouring
# counts, too. Then the tube is gone and all get the speed of the fall, a twentieth of a millimetre above the plate:
# the fall itself is not run, as it changes nothing within a heap. Contacts are softened: steel E / stiffen. The
# finest carriers touch the plate for 43 us when they hit it at 2 m/s, 18 steps. Steel, calcium carbonate. SI units.

variable carriers         index 600
variable fine             index 1.0e-3    # sieve fractions: diameters of the carriers, m
variable middle           index 1.2e-3
variable coarse           index 1.5e-3
variable speed            index 0.1       # with which they are poured, m/s
variable height           index 0.2       # of the fall, m
variable tube             index 20e-3     # inner diameter, m
variable restitution      index 0.7       # of all contacts
variable friction_steel   index 0.3       # carriers against each other, tube and plate
variable coverage         index 0.2       # grain cross-sections / carrier surface
variable seed             index 1         # of the textures, the carriers' orientations and where they come
variable grain_diameter   index 20e-6     # m
variable spread           index 1         # geometric standard deviation of the grains' pull-off forces
variable hamaker          index 14.633e-20    # grain against carrier, J
variable z0               index 0.4e-9    # m
variable friction         index 0.3       # grain against carrier
variable stiffen          index 1000      # the contacts are so many times softer than steel
variable contact_steps    index 20        # of two carriers that meet with 1 m/s; -var timestep (s) may take its place
variable settle           index 0.08      # s of pouring and settling
variable splash           index 0.01      # s after the fall
variable plugin           index ./dustplugin.so

if "${height} < 0" then "print 'height ${height} must be at least 0 (m)'" "quit 1"
if "${stiffen} < 1" then "print 'stiffen ${stiffen} must be at least 1'" "quit 1"
if "${contact_steps} < 10" then "print 'contact_steps ${contact_steps} must be at least 10'" "quit 1"
if "${fine} >= ${middle} || ${middle} >= ${coarse}" then &
                "print 'fine ${fine} must be below middle ${middle}, and that below coarse ${coarse} (m)'" "quit 1"
if "${tube} < $(5*v_coarse) || ${tube} > 0.1" then "print 'tube ${tube} must be five carriers to 0.1 (m)'" "quit 1"

plugin load ${plugin}    # lmp-dust goes on without it

units           si
atom_style      sphere
boundary        f f f
newton          off
comm_modify     vel yes

# a third of the mass each: by number as 1/d^3
variable        all equal v_fine^-3+v_middle^-3+v_coarse^-3
variable        fines equal $(v_fine^-3/v_all:%.12f)
variable        middles equal $(v_middle^-3/v_all:%.12f)

# the source holds them all at 12 % of its volume, above the heap
variable        d equal v_coarse
variable        free equal 0.5*(v_tube-v_d)
variable        low equal 0.5*v_tube
variable        high equal v_low+v_carriers*3/v_all/(6*0.11*v_free^2)+v_d
region          box block -0.06 0.06 -0.06 0.06 0 $(v_high+0.06)
create_box      1 box

# Hertz' contact time, 2.868 (m^2/(R E*^2 v))^0.2 with half of a fine carrier's mass and a quarter of its diameter
variable        contact equal 2.868*v_fine*(7700*PI/6*1.82*v_stiffen/210e9)^0.4
if "!$(is_defined(variable,timestep))" then "variable timestep string $(v_contact/v_contact_steps:%.1e)"
timestep        ${timestep}
neighbor        $(0.25*v_d) bin
variable        steel string "hertz/material $(210e9/v_stiffen) ${restitution} 0.3 tangential mindlin NULL 0.0 &
                ${friction_steel} damping coeff_restitution/limited"
pair_style      granular
pair_coeff      * * ${steel}

region          tube cylinder z 0 0 $(v_tube/2) INF INF side in
fix             move all nve/sphere
fix             plate all wall/gran granular ${steel} zplane 0.0 NULL
fix             tube all wall/gran/region granular ${steel} region tube
fix             dust all dust/detach texture monolayer ${grain_diameter} coverage ${coverage} seed ${seed} sizes 0 &
                spread ${spread} density 2700 hamaker ${hamaker} ${z0} elastic 75e9 0.3 210e9 0.3 &
                friction ${friction} orientation random ${seed} stiffen ${stiffen} rows no
fix             fall all gravity 9.81 vector 0 0 -1
region          source cylinder z 0 0 ${free} ${low} ${high}
fix             pour all pour ${carriers} 1 ${seed} region source dens 7700 7700 vol 0.12 500 vel 0 0 0 0 -${speed} &
                diam poly 3 ${fine} ${fines} ${middle} ${middles} ${coarse} $(1-v_fines-v_middles:%.12f)

# by fraction: carriers, and the share of its dust that has come off
variable        limit1 equal 0.25*(v_fine+v_middle)
variable        limit2 equal 0.25*(v_middle+v_coarse)
variable        grain equal 2700*PI/6*v_grain_diameter^3
variable        is1 atom "radius < v_limit1"
variable        is3 atom "radius > v_limit2"
variable        is2 atom 1-v_is1-v_is3
variable        had atom f_dust[1]*v_grain+f_dust[2]
variable        k loop 3
label           fraction
variable        had$k atom v_is$k*v_had
variable        lost$k atom v_is$k*f_dust[2]
next            k
jump            SELF fraction
compute         number all reduce sum v_is1 v_is2 v_is3
compute         had all reduce sum v_had1 v_had2 v_had3
compute         lost all reduce sum v_lost1 v_lost2 v_lost3
variable        off1 equal c_lost[1]/(c_had[1]+1e-300)
variable        off2 equal c_lost[2]/(c_had[2]+1e-300)
variable        off3 equal c_lost[3]/(c_had[3]+1e-300)

print           "Pour"
thermo_style    custom step time cpu atoms f_dust v_off1 v_off2 v_off3 c_number[1] c_number[2] c_number[3]
thermo_modify   norm no
variable        settling equal ceil(v_settle/v_timestep)
thermo          $(ceil(v_settling/20))
run             ${settling}
variable        poured string "$(v_off1:%.4f) of the fine, $(v_off2:%.4f) of the middle, $(v_off3:%.4f) of the coarse"

print           "Fall"
unfix           pour
unfix           tube
displace_atoms  all move 0 0 5e-5
velocity        all set 0 0 -$(sqrt(2*9.81*v_height)) sum yes
variable        often equal round(1e-4/v_timestep)
if "$(is_defined(variable,dump))" then "dump carriers all custom ${often} ${dump} id x y z radius vx vy vz f_dust[1] &
                f_dust[2] v_had"
variable        splashing equal ceil(v_splash/v_timestep)
thermo          $(ceil(v_splashing/20))
thermo_modify   lost ignore norm no
run             ${splashing}

print "carriers: $(c_number[1]) fine, $(c_number[2]) middle, $(c_number[3]) coarse"
print "off by pouring: ${poured}"
print "off in all: $(v_off1:%.4f) of the fine, $(v_off2:%.4f) of the middle, $(v_off3:%.4f) of the coarse"
print "dispersion ratio $(f_dust:%.4f)"
