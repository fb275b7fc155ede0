"""The workbench: a mechanism drawn, dragged and computed in a browser; the text of its description is the only state."""
