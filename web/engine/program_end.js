globalThis.createVelo = createVelo; // for engine/velo.mjs, which imports this file as a module
