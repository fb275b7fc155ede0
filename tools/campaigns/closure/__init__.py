"""Closure equations of any mechanism, their solutions in doubles and in many digits, the curve they make."""
