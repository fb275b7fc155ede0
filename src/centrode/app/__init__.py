"""The workbench: a mechanism drawn, dragged and computed in a browser; its state is the text of the description."""
