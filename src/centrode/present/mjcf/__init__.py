"""Linkages as models of MuJoCo: a tree of bodies, and equality constraints where its loops close."""
