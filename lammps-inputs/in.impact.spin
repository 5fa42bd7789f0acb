# A spinning carrier covered with dust hits a wall: how much comes off? Detachment functions that follow the carrier's
# turning. Takes about 0.1 s.
#
#   lmp -in in.impact.spin                               (dustplugin.so and dust_styles.so in the working folder)
#   lmp -in in.impact.spin -var spin -5000 -var angle 60 -var plugin /path/to/dustplugin.so
#   lmp -in in.impact.spin -var events FILE              (also list the grains that detach)
#
# Same impact with real grains: in.impact.resolved -var spin 2000 -var wall_friction 0.3. 1.5 mm steel carrier, 20 um
# calcium carbonate grains. Above 13200 rad/s the grains at the carrier's equator leave it in free flight. SI units.

variable speed            index 8.0       # m/s
variable angle            index 90        # degrees between velocity and wall
variable spin             index 2000      # about y, rad/s; above 0 as when it rolls on, towards +x
variable restitution      index 0.7       # carrier against wall
variable wall_friction    index 0.3       # what spin acts through
variable coverage         index 0.2       # grain cross-sections / carrier surface
variable seed             index 1
variable carrier_diameter index 1.5e-3    # m
variable grain_diameter   index 20e-6     # m
variable carrier_density  index 7700      # kg/m3
variable carrier_modulus  index 210e9     # Young's modulus of carrier and wall, Pa, and their Poisson's ratios
variable carrier_poisson  index 0.3
variable wall_modulus     index 210e9
variable wall_poisson     index 0.3
variable grain_density    index 2700      # kg/m3
variable grain_modulus    index 75e9      # Pa
variable grain_poisson    index 0.3
variable hamaker          index 14.633e-20    # grain against carrier, J
variable z0               index 0.4e-9    # m
variable friction         index 0.3       # grain against carrier
variable tangential       index impulse
variable timestep         index 1e-9      # s
variable limit            index 200000    # steps
variable rotation         index yes       # no: as if the carrier did not turn
variable plugin           index ./dustplugin.so

if "${speed} <= 0" then "print 'speed ${speed} must be above 0 (m/s)'" "quit 1"
if "${angle} <= 0 || ${angle} > 90" then "print 'angle ${angle} must be above 0 and at most 90 (degrees)'" "quit 1"

plugin load ${plugin}    # lmp-dust goes on without it

units           si
atom_style      sphere
boundary        f f f
newton          off
comm_modify     vel yes

variable radius equal 0.5*v_carrier_diameter
variable vx     equal  v_speed*cos(v_angle*PI/180)
variable vz     equal -v_speed*sin(v_angle*PI/180)
variable start  equal v_radius-5*v_vz*v_timestep    # five steps before contact

# the carrier moves on by no more than a few hundred contact overlaps: a box of a few diameters holds it
region          box block -$(4*v_radius) $(8*v_radius) -$(2*v_radius) $(2*v_radius) -$(v_radius) $(6*v_radius)
create_box      1 box
create_atoms    1 single 0.0 0.0 ${start}
set             group all diameter ${carrier_diameter} density ${carrier_density}
velocity        all set ${vx} 0.0 ${vz}
set             group all omega 0.0 ${spin} 0.0

# one material with the E* and G* of carrier and wall: 2 G*/E* = (1 - nu)/(2 - nu); two alike are their own
variable same   equal v_carrier_modulus==v_wall_modulus&&v_carrier_poisson==v_wall_poisson
variable Ew     equal 1/((1-v_carrier_poisson^2)/v_carrier_modulus+(1-v_wall_poisson^2)/v_wall_modulus)
variable shear1 equal 2*(2-v_carrier_poisson)*(1+v_carrier_poisson)/v_carrier_modulus
variable shear2 equal 2*(2-v_wall_poisson)*(1+v_wall_poisson)/v_wall_modulus
variable Gw     equal 1/(v_shear1+v_shear2)
variable pair_poisson equal ternary(v_same,v_carrier_poisson,(1-4*v_Gw/v_Ew)/(1-2*v_Gw/v_Ew))
variable pair_modulus equal ternary(v_same,v_carrier_modulus,2*(1-v_pair_poisson^2)*v_Ew)

timestep        ${timestep}
neighbor        $(0.2*v_radius) bin
pair_style      granular
pair_coeff      * * hertz/material ${carrier_modulus} ${restitution} ${carrier_poisson} &
                tangential mindlin NULL 0.0 ${wall_friction} damping coeff_restitution/limited

fix             move all nve/sphere
fix             wall all wall/gran granular hertz/material $(v_pair_modulus:%.17g) ${restitution} &
                $(v_pair_poisson:%.17g) tangential mindlin NULL 0.0 ${wall_friction} &
                damping coeff_restitution/limited zplane 0.0 NULL

# half-angle without grains where the carrier hits (rad): -var bare, or as wide as the grains need it, 0.33 for these
variable        cap string ""
if "$(is_defined(variable,bare))" then "variable cap string 'bare ${bare}'"
variable        adhesion string "hamaker ${hamaker} ${z0}"
if "$(is_defined(variable,surface_energy))" then "variable adhesion string 'surface ${surface_energy}'"
variable        ringing string ""
if "$(is_defined(variable,grain_damping))" then "variable ringing string 'damping ${grain_damping}'"
fix             dust all dust/detach texture monolayer ${grain_diameter} coverage ${coverage} seed ${seed} &
                ${cap} density ${grain_density} ${adhesion} &
                elastic ${grain_modulus} ${grain_poisson} ${carrier_modulus} ${carrier_poisson} friction ${friction} &
                tangential ${tangential} rotation ${rotation} every 100 ${ringing}

# one line a grain: step, carrier, grain, mode (1 normal, 2 tangential), diameter, position, velocity
if "$(is_defined(variable,events))" then "dump events all local 100 ${events} f_dust[1] f_dust[2] f_dust[3] &
                f_dust[4] f_dust[5] f_dust[6] f_dust[7] f_dust[8] f_dust[9] f_dust[10] f_dust[11] &
                f_dust[12]"

# stop when the carrier has left the wall
variable        finished equal f_dust[9]
fix             stop all halt 100 v_finished > 0 error continue message no

compute         spin all property/atom omegay
compute         spun all reduce sum c_spin
thermo          1000
thermo_style    custom step time cpu f_dust f_dust[3] f_dust[4] f_dust[9] c_spun
thermo_modify   norm no
run             ${limit}

print "carrier: $(vcm(all,x):%.4f) 0 $(vcm(all,z):%.4f) m/s, spin $(c_spun:%.1f) rad/s"
print "dispersion ratio $(f_dust:%.4f): south $(f_dust[5]/f_dust[1]:%.4f), north $(f_dust[6]/f_dust[1]:%.4f)"
