"""Drawings for the shop: the mechanism at full size in conventional signs, as DXF and SVG in layers."""
