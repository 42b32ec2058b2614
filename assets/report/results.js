// Results of a rocket as a person reads them.
export const DEG = ["deg", 180 / Math.PI], MRAD = ["mrad", 1e3], MM = ["mm", 1e3], KN = ["kN", 1e-3];

// Key of a rocket in summary.json, what it is called, unit and factor.
export const ROCKET = [
  ["tube", "tube", "", 1],
  ["t_ignition", "ignition, on the run's clock", "s", 1],
  ["t_release", "release", "ms", 1e3],
  ["t_front", "front adaptor leaves", "ms", 1e3],
  ["t_middle", "middle adaptor leaves", "ms", 1e3],
  ["t_rear", "rear adaptor leaves", "ms", 1e3],
  ["muzzle_speed", "speed along the tube as it leaves", "m/s", 1],
  ["inertial_speed", "speed over ground as it leaves", "m/s", 1],
  ["spin_rate", "spin", "rad/s", 1],
  ["pitch", "pitch", ...DEG],
  ["yaw", "yaw", ...DEG],
  ["pitch_rate", "pitch rate", "mrad/s", 1e3],
  ["yaw_rate", "yaw rate", "mrad/s", 1e3],
  ["tip.y", "tip of the tube, y", ...MM],
  ["tip.z", "tip of the tube, z", ...MM],
  ["tip.pitch", "tip of the tube, pitch", ...MRAD],
  ["tip.yaw", "tip of the tube, yaw", ...MRAD],
  ["max_contact_force.*", "largest contact force, %s", ...KN],
  ["max_slot_force", "largest slot force", ...KN],
  ["flight.apogee", "apogee", "m", 1],
  ["flight.range", "range", "m", 1],
  ["flight.drift", "drift", "m", 1],
  ["flight.time_of_flight", "time of flight", "s", 1],
  ["flight.impact_speed", "speed at impact", "m/s", 1],
  ["flight.impact_angle", "angle of impact", ...DEG],
  ["flight.max_mach", "largest Mach number", "", 1],
  ["flight.max_angle_of_attack", "largest angle of attack", ...DEG],
];
