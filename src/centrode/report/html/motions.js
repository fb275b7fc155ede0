
for (const holder of document.querySelectorAll(".moving")) new Stage(holder);
