# SPDX-License-Identifier: Apache-2.0
"""Random lighting (docs/scene.md)."""


def light(dice):
    found = {"direction": "headlight" if dice.chance(0.4) else dice.direction()}
    if dice.chance(0.5):
        found["color"] = [1, 1, 1] if dice.chance(0.3) else dice.vector(0, 1)
    return found


def make(dice, span, length):
    """`span`: lowest and highest value, none if all are NaN; `length` of the data in world units."""
    lighting = {}
    if dice.chance(0.6):
        lighting["ambient"] = dice.pick(0, 1, dice.between(0, 1))
    if dice.chance(0.6):
        lighting["diffuse"] = dice.pick(0, dice.between(0, 1))
    if dice.chance(0.6):
        lighting["specular"] = dice.pick(0, dice.between(0, 1))
    if dice.chance(0.6):
        lighting["power"] = dice.pick(1, 10, 64, dice.between(1, 200))
    height = span[1] - span[0] if span else 0
    if dice.chance(0.3) and height > 0:
        steepness = height / length * dice.log_between(0.01, 10)
        if 1e-140 < steepness < 1e140:
            lighting["smallest_gradient"] = float(f"{steepness:.6e}")
    if dice.chance(0.6):
        lighting["lights"] = [light(dice) for _ in range(dice.pick(1, 1, 2, 3))]
    return lighting


def brightest(lighting, color):
    """The brightest that a colour up to `color` may get."""
    lights = lighting.get("lights", [{}])
    total = max(sum(light.get("color", [1, 1, 1])[channel] for light in lights) for channel in range(3))
    factor = lighting.get("ambient", 0.1) + lighting.get("diffuse", 0.7) * total
    return max(1.0, color * max(1.0, factor) + lighting.get("specular", 0.2) * total)
