"""A Gymnasium environment whose joint rubs as the recorded one does: the friction of an image, evaluated as the drive does.

    python trainer/python/examples/gymnasium_joint.py fixtures/elbow.frk
"""

import sys

import gymnasium
import numpy as np

import frikan


class Joint(gymnasium.Env):
    """A joint to bring to a goal by its torque. Observed are position, velocity and goal; a step is 2 ms."""

    STEP_S = 0.002
    STEPS = 1000

    def __init__(self, image, inertia=0.5, torque_limit=10.0):
        self.friction = frikan.Image.load(image)
        self.inertia, self.torque_limit = inertia, torque_limit
        self.action_space = gymnasium.spaces.Box(-torque_limit, torque_limit, (1,), np.float64)
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (3,), np.float64)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.position, self.velocity, self.steps = 0.0, 0.0, 0
        self.goal = self.np_random.uniform(-1, 1)
        return self._observed(), {}

    def step(self, action):
        torque = float(np.clip(action[0], -self.torque_limit, self.torque_limit))
        free = self.velocity + self.STEP_S * torque / self.inertia
        # Friction brings a joint to rest and no further.
        slowed = free - self.STEP_S * float(self.friction(free)) / self.inertia
        self.velocity = slowed if slowed * free > 0 else 0.0
        self.position += self.STEP_S * self.velocity
        self.steps += 1
        reward = -abs(self.goal - self.position)
        return self._observed(), reward, False, self.steps == self.STEPS, {}

    def _observed(self):
        return np.array([self.position, self.velocity, self.goal])


def left_after(environment, compensates, seed=3):
    """Distance to the goal at the end under a PD controller, with the friction fed forward or not, rad."""
    (position, velocity, goal), _ = environment.reset(seed=seed)
    is_over = False
    while not is_over:
        torque = 20 * (goal - position) - 4 * velocity
        if compensates:
            # Of the motion that is wanted, not of the measured one: at rest that one says nothing.
            torque += float(environment.friction(0.2 * np.sign(goal - position) + velocity))
        (position, velocity, goal), _, _, is_over, _ = environment.step([torque])
    return abs(goal - position)


if __name__ == "__main__":
    joint = Joint(sys.argv[1])
    for name, compensates in [("without", False), ("with", True)]:
        print(f"{1000 * left_after(joint, compensates):.1f} mrad off the goal {name} compensation")
