"""Modules of `hamel emit --language python` in JAX: compiled and differentiated."""

import jax
import numpy as np
from test_emitted import MODELS, emitted, the_class

import hamel

jax.config.update("jax_enable_x64", True)


def test_jax_differentiates_and_compiles(tmp_path):
    _, module = emitted(MODELS / "heavy_top.eom", tmp_path)
    own, system = the_class(module)(xp=jax.numpy), hamel.System.from_file(MODELS / "heavy_top.eom")
    x, xi, u = np.array(system.start().x), np.array([0.3, -0.2, 5.0]), np.zeros(0)
    assert np.allclose(jax.jit(own.accel)(x, xi, u), system.accel(x, xi, u), atol=1e-12)
    slopes = jax.jacfwd(own.accel, argnums=1)(x, xi, u)
    step = 1e-6 * np.eye(3)
    known = np.stack([(system.accel(x, xi + d, u) - system.accel(x, xi - d, u)) / 2e-6 for d in step], axis=1)
    assert np.allclose(slopes, known, atol=1e-6)
