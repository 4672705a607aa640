"""An elastic disk that rolls down 60 degrees, as an equation of three motions: how far is it from a rigid one?

Independent of talus, for docs/experiments/rolling.md. The disk is rigid but for its contact: the approach of a cylinder
and a rigid plane (Hertz; Johnson, Contact Mechanics, 1985, section 5.6), delta = N (2 ln(4 R / b) - 1) / (pi E*) with
b^2 = 4 N R / (pi E*), and a tangential spring as stiff, which is carried out of the contact as the disk rolls on, so that
steady rolling creeps by xi = T b / (2 N R) (Carter, small creep; section 8.3); Coulomb's cone bounds it. Explicit
steps of 20 microseconds. Prints error (4.44) of the thesis, way and spin after 1 s against rolling without slip.
"""
import bisect
import math

RADIUS, DENSITY, YOUNG, POISSON, GRAVITY, SLOPE = 0.5, 7800.0, 200e6, 0.3, 9.81, math.radians(60)
MASS = DENSITY * math.pi * RADIUS**2
EFFECTIVE = YOUNG / (1 - POISSON**2)
RIGID_WAY, RIGID_SPIN = GRAVITY * math.sin(SLOPE) / 3, GRAVITY * math.sin(SLOPE) * 2 / 3 / RADIUS


def half_width(force):
    return math.sqrt(4 * force * RADIUS / (math.pi * EFFECTIVE))


def compliance(force):
    return (2 * math.log(4 * RADIUS / half_width(force)) - 1) / (math.pi * EFFECTIVE)


FORCES = [10 ** (6.5 * i / 2000) for i in range(2001)]
DEPTHS = [force * compliance(force) for force in FORCES]


def normal_force(depth):
    if depth <= DEPTHS[0]:
        return max(0.0, FORCES[0] * depth / DEPTHS[0])
    i = min(bisect.bisect(DEPTHS, depth), len(DEPTHS) - 1)
    share = (depth - DEPTHS[i - 1]) / (DEPTHS[i] - DEPTHS[i - 1])
    return FORCES[i - 1] + share * (FORCES[i] - FORCES[i - 1])


def roll(friction, settled, dt=2e-5):
    weight = MASS * GRAVITY * math.cos(SLOPE)
    depth = weight * compliance(weight) if settled else 0.0
    x = vx = vy = spin = stretch = work = error = 0.0
    per_sample = round(0.01 / dt)
    for i in range(round(1 / dt)):
        pressed, tangential = normal_force(depth), 0.0
        if pressed > 0:
            stiffness = 1 / compliance(max(pressed, FORCES[0]))
            slip = vx - spin * RADIUS
            # the spring leaves the contact after rolling this far
            length = 2 * pressed * RADIUS / half_width(pressed) / stiffness
            stretch += dt * (slip - abs(vx) * stretch / length)
            tangential = max(-friction * pressed, min(friction * pressed, stiffness * stretch))
            stretch = tangential / stiffness
            work += tangential * slip * dt
        else:
            stretch = 0.0
        vx += dt * (GRAVITY * math.sin(SLOPE) - tangential / MASS)
        vy += dt * (pressed / MASS - GRAVITY * math.cos(SLOPE))
        spin += dt * tangential * 2 / (MASS * RADIUS)
        x += dt * vx
        depth -= dt * vy
        if (i + 1) % per_sample == 0:
            t = (i + 1) * dt
            error += (math.cos(SLOPE) * (x - RIGID_WAY * t * t)) ** 2
    print(f"friction {friction:g}, {'it stands on the plane' if settled else 'gravity at once'}: error {error**0.5:.4f} m, "
          f"way {100 * (x / RIGID_WAY - 1):+.2f} %, spin {100 * (spin / RIGID_SPIN - 1):+.2f} %, work of slip {work:.0f} J")


if __name__ == "__main__":
    for settled in (False, True):
        for friction in (1, 100):
            roll(friction, settled)
