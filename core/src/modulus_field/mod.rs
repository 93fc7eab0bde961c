//! The modulus along a spoke as one closed-form expression.
