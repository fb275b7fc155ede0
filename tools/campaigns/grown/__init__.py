"""Random mechanisms grown group by group: placed first and measured afterwards, so that they assemble."""
